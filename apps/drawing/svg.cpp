// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/svg.h"

#include <cmath>

#include "common/report.h"

namespace gaussmap::app {
namespace {

std::string escaped(const std::string& text) {
  std::string escaped;
  for (const char c : validUtf8(text)) {
    const bool is_control = static_cast<unsigned char>(c) < 0x20;
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else
      escaped += is_control ? '?' : c;
  }
  return escaped;
}

}  // namespace

Svg::Svg(double width, double height, double font_size) {
  svg_ << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
       << "' font-family='sans-serif' font-size='" << font_size
       << "'>\n<rect width='100%' height='100%' fill='white'/>\n";
}

void Svg::text(double x, double y, const std::string& text, const std::string& attributes) {
  svg_ << "<text x='" << x << "' y='" << y << "' " << attributes << '>' << escaped(text) << "</text>\n";
}

void Svg::save(const std::filesystem::path& path) const {
  writeText(path, svg_.str() + "</svg>\n");
}

std::string numberText(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

double widthOf(const std::string& text) {
  constexpr double kCharacter = 6.2;  // upper bound of the mean width of a character of 11 pixels
  return kCharacter * static_cast<double>(text.size());
}

double roundLength(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= length) return step * decade;
  return decade;
}

}  // namespace gaussmap::app
