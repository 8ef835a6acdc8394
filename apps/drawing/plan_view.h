// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drawing/svg.h"
#include "gaussmap/map/queries.h"

namespace gaussmap::app {

/// A window of the map, seen from above, and its place in a picture.
struct PlanView {
  Box<2> window;        ///< [m], map frame
  double scale = 1.0;   ///< pixels per metre
  double margin = 0.0;  ///< to the left of the window and above it [pixels]

  // Positions and sizes in the picture [pixels].
  double x(double metres) const { return margin + (metres - window.low.x()) * scale; }
  double y(double metres) const { return margin + (window.high.y() - metres) * scale; }
  double width() const { return (window.high.x() - window.low.x()) * scale; }   ///< without margins
  double height() const { return (window.high.y() - window.low.y()) * scale; }  ///< without margins

  /// Draws a bar with its length below it. The length is the longest round number of metres that takes at most
  /// `pixels`. Returns the length of the bar [pixels].
  double drawScaleBar(Svg& svg, double left, double top, double pixels) const;
};

/// Returns an empty box, which include() extends.
Box<2> emptyBox();
/// Extends the box to contain the point.
void include(Box<2>& box, const Vector<2>& point);

}  // namespace gaussmap::app
