// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::app {

/// The ellipsoid of a Gaussian, seen from above.
struct Ellipse {
  Vector<2> centre;    ///< [m], map frame
  Vector<2> axis;      ///< the longer half axis [m]
  double width = 0.0;  ///< the shorter half axis [m]
  double value = 0.0;  ///< has a colour of the colour bar; from ellipseFromAbove(): z of the highest point [m]
  std::string colour;  ///< "#rrggbb"; empty: the colour of the value

  /// Half the sides of the box around the ellipse [m].
  Vector<2> reach() const;
};

/// Returns the exact projection of the ellipsoid of `sigma` standard deviations: the ellipse of the marginal
/// distribution of x and y.
Ellipse ellipseFromAbove(const Gaussian<3>& gaussian, double sigma);

/// A cell, seen from above.
struct Square {
  Box<2> box;                   ///< [m], map frame
  std::optional<double> value;  ///< the square is filled with the colour of the value; nullopt: it is not filled
};

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
  bool is_filled = true;          ///< false: only the outlines of the ellipses are drawn
  bool has_large_on_top = false;  ///< true: large ellipses lie on small ones; false: the other way round
  std::vector<Square> squares;    ///< drawn with black borders behind the ellipses
  std::vector<ColourKey> keys;    ///< what the colours mean
};

/// What the colour bar shows.
struct BarOptions {
  std::string title = "top of the ellipsoid [m]";  ///< what the values are, with their unit
  bool is_logarithmic = false;                     ///< see ColourScale
  double opacity = 1.0;                            ///< of the filled squares and of the bar
};

/// Writes an SVG picture of the panels, with a scale bar, and with a colour bar if a value has a colour, and the keys
/// of the first panel that has some. All panels are drawn to the same scale and have the same colours, see
/// colourScale(). They stand side by side, or one above the other if that makes them more than 1.5 times as large.
/// Ellipses are clipped to the window [m]. At least one panel must have an ellipse. Throws FileError if the file cannot
/// be written.
void drawMaps(std::vector<Panel> panels, const Box<2>& window, const BarOptions& bar,
              const std::filesystem::path& path);

}  // namespace gaussmap::app
