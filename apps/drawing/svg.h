// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <sstream>
#include <string>

namespace gaussmap::app {

/// An SVG picture on a white background. Lengths are in pixels, y points down.
class Svg {
 public:
  Svg(double width, double height, double font_size = 12);

  /// Appends SVG code unchanged.
  template <typename T>
  Svg& operator<<(const T& piece) {
    svg_ << piece;
    return *this;
  }
  /// Appends a line of text; (x, y) is on its baseline. `attributes` are SVG attributes such as "text-anchor='end'".
  /// Bytes that SVG cannot contain are replaced.
  void text(double x, double y, const std::string& text, const std::string& attributes = "");

  /// Throws FileError if the file cannot be written.
  void save(const std::filesystem::path& path) const;

 private:
  std::ostringstream svg_;
};

/// Formats a number with at most ten digits and without trailing zeros: "0.25".
std::string numberText(double value);

/// Returns an upper bound of the width of a line of text of the size that drawMaps() uses [pixels].
double widthOf(const std::string& text);

/// Returns the largest number of the form 1, 2 or 5 times a power of ten that is at most `length`; `length` > 0.
double roundLength(double length);

}  // namespace gaussmap::app
