// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::app {

/// A Gaussian's ellipsoid as it is seen from above.
struct Ellipse {
  Vector<2> centre;    ///< [m], map frame
  Vector<2> axis;      ///< the longer half axis [m]
  double width = 0.0;  ///< the shorter half axis [m]
  double top = 0.0;    ///< z of the ellipsoid's highest point [m]

  /// Half the sides of the box around the ellipse [m].
  Vector<2> reach() const;
};

/// The shadow of all points within `sigma` standard deviations: the ellipse of the marginal of x and y, exactly.
Ellipse ellipseFromAbove(const Gaussian<3>& gaussian, double sigma);

/// One map from above.
struct Panel {
  std::string title;
  double cell_side = 0.0;  ///< of the grid behind the ellipses [m]
  std::vector<Ellipse> ellipses;
};

/// Writes SVG: the panels in one scale, side by side, or one above the other where that makes them half again as
/// large; a scale bar and a colour bar. Ellipses are clipped to the window [m], small ones lie on large ones. Their
/// colour is the height of their top; the ends of the colours are its 1 % and 99 % quantiles. There must be an ellipse.
/// Throws FileError if it cannot be written.
void drawMaps(std::vector<Panel> panels, const Box<2>& window, const std::filesystem::path& path);

}  // namespace gaussmap::app
