// SPDX-License-Identifier: BSD-3-Clause
#include "svg.h"

#include <cmath>

#include "common.h"
#include "io/files/atomic_file.h"

namespace gaussmap::app {
using namespace detail;

namespace {

/// File names need not be UTF-8, as XML must be.
std::string escaped(const std::string& text) {
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string escaped;
  for (const char c : Json::parse(quoted).get<std::string>()) {
    const bool control = static_cast<unsigned char>(c) < 0x20;
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      default:
        escaped += control ? '?' : c;
    }
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
  const std::string text = svg_.str() + "</svg>\n";
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

std::string numberText(double value) {
  std::ostringstream text;
  text.precision(10);
  text << value;
  return text.str();
}

double roundLength(double length) {
  const double decade = std::pow(10.0, std::floor(std::log10(length)));
  for (const double step : {5.0, 2.0})
    if (step * decade <= length) return step * decade;
  return decade;
}

}  // namespace gaussmap::app
