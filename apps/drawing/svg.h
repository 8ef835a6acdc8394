// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <sstream>
#include <string>

namespace gaussmap::app {

/// A picture as text, on a white ground; lengths in pixels, y down.
class Svg {
 public:
  Svg(double width, double height, double font_size = 12);

  /// Appends SVG as it is.
  template <typename T>
  Svg& operator<<(const T& piece) {
    svg_ << piece;
    return *this;
  }
  /// A line of text at its baseline; `attributes` such as "text-anchor='end'". Bytes that SVG cannot hold are replaced.
  void text(double x, double y, const std::string& text, const std::string& attributes = "");

  /// Throws FileError if it cannot be written.
  void save(const std::filesystem::path& path) const;

 private:
  std::ostringstream svg_;
};

/// "0.25": at most ten digits, without trailing zeros.
std::string numberText(double value);

/// The largest of 1, 2, 5, 10, 20, ... (and their tenths, hundredths, ...) that is at most `length` > 0.
double roundLength(double length);

}  // namespace gaussmap::app
