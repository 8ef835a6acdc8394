// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "drawing/svg.h"

namespace gaussmap::app {

/// The colours of values, from pale for low ones to dark for high ones, and their colour bar.
struct ColourScale {
  std::string title;             ///< of the colour bar, with the unit
  double low = 0.0, high = 0.0;  ///< values of the first and the last colour; equal: no value has a colour
  bool is_logarithmic = false;   ///< equal steps of colour are equal factors; low > 0
  bool empty() const { return !(low < high); }

  /// Returns the colour "#rrggbb" of a value; grey if it is not a number.
  std::string colourOf(double value) const;
  /// Draws the colour bar with its title and its numbers. `right`, `top`: its right upper corner [pixels].
  void draw(Svg& svg, double right, double top, double opacity) const;
  /// Returns the width of the bar with its title [pixels].
  double width() const;
};

/// Returns a scale for these values. Its ends are their 1 % and 99 % quantiles, so that a few outliers do not use up
/// the colours. A logarithmic scale covers the positive values, at most a factor of 10,000 below its upper end.
ColourScale colourScale(const std::string& title, const std::vector<double>& values, bool is_logarithmic);

}  // namespace gaussmap::app
