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
  std::string colour;  ///< "#rrggbb"; empty: the colour of the height

  /// Half the sides of the box around the ellipse [m].
  Vector<2> reach() const;
};

/// Returns the exact projection of the ellipsoid of `sigma` standard deviations: the ellipse of the marginal
/// distribution of x and y.
Ellipse ellipseFromAbove(const Gaussian<3>& gaussian, double sigma);

/// A colour and its meaning.
struct ColourKey {
  std::string colour;  ///< "#rrggbb"
  std::string text;
  bool is_outline = false;  ///< the shapes of this colour are not filled
};

/// One map, seen from above.
struct Panel {
  std::string title;
  double cell_side = 0.0;  ///< of the grid behind the ellipses [m]; 0: no grid
  std::vector<Ellipse> ellipses;
  std::vector<Box<2>> squares;  ///< drawn in black behind the ellipses [m]
  std::vector<ColourKey> keys;  ///< what the colours mean
};

/// Writes an SVG picture of the panels, with a scale bar, and with a colour bar if a colour shows a height, and the
/// keys of the first panel that has some. All panels are drawn to the same scale. They stand side by side, or one above
/// the other if that makes them more than 1.5 times as large. Ellipses are clipped to the window [m], and small
/// ellipses lie on large ones. The colour is the height of the ellipsoid's top; the ends of the colour bar are the 1 %
/// and 99 % quantiles of this height. At least one panel must have an ellipse. Throws FileError if the file cannot be
/// written.
void drawMaps(std::vector<Panel> panels, const Box<2>& window, const std::filesystem::path& path);

}  // namespace gaussmap::app
