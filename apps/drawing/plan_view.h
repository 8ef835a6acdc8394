// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drawing/svg.h"
#include "gaussmap/map/queries.h"

namespace gaussmap::app {

/// A window of the map from above, and how it lies in a picture.
struct PlanView {
  Box<2> window;        ///< [m], map frame
  double scale = 1.0;   ///< pixels per metre
  double margin = 0.0;  ///< left of and above the window [pixels]

  // In pixels.
  double x(double metres) const { return margin + (metres - window.low.x()) * scale; }
  double y(double metres) const { return margin + (window.high.y() - metres) * scale; }
  double width() const { return (window.high.x() - window.low.x()) * scale; }   ///< without margins
  double height() const { return (window.high.y() - window.low.y()) * scale; }  ///< without margins

  /// A bar with its length below; the longest round length of at most `pixels`. Returns its length [pixels].
  double drawScaleBar(Svg& svg, double left, double top, double pixels) const;
};

/// A box that contains nothing, to be grown by include().
Box<2> emptyBox();
void include(Box<2>& box, const Vector<2>& point);

}  // namespace gaussmap::app
