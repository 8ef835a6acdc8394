// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::app {

/// The ellipsoid of a Gaussian, seen from above.
struct Ellipse {
  Vector<2> centre;    ///< [m], map frame
  Vector<2> axis;      ///< the longer half axis [m]
  double width = 0.0;  ///< the shorter half axis [m]
  double top = 0.0;    ///< z of the ellipsoid's highest point [m]

  /// Half the sides of the box around the ellipse [m].
  Vector<2> reach() const;
};

/// Returns the exact projection of the ellipsoid of `sigma` standard deviations: the ellipse of the marginal
/// distribution of x and y.
Ellipse ellipseFromAbove(const Gaussian<3>& gaussian, double sigma);

/// One map, seen from above.
struct Panel {
  std::string title;
  double cell_side = 0.0;  ///< of the grid behind the ellipses [m]
  std::vector<Ellipse> ellipses;
};

/// Writes an SVG picture of the panels, with a scale bar and a colour bar. All panels are drawn to the same scale. They
/// stand side by side, or one above the other if that makes them more than 1.5 times as large. Ellipses are clipped to
/// the window [m], and small ellipses lie on large ones. The colour is the height of the ellipsoid's top; the ends of
/// the colour bar are the 1 % and 99 % quantiles of this height. At least one panel must have an ellipse. Throws
/// FileError if the file cannot be written.
void drawMaps(std::vector<Panel> panels, const Box<2>& window, const std::filesystem::path& path);

}  // namespace gaussmap::app
