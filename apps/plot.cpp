// SPDX-License-Identifier: BSD-3-Clause
#include "plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "gaussmap/io/atomic_file.h"

namespace gaussmap::app {
namespace {

constexpr double kWidth = 640, kHeight = 420, kLeft = 70, kRight = 190, kTop = 20, kBottom = 50;
constexpr const char* kColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"};

/// A logarithmic axis from whole powers of ten.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;  // decades after close()
  double from = 0.0, to = 1.0;                                       // pixels
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void close() {
    low = std::floor(std::log10(low));
    high = std::max(std::ceil(std::log10(high)), low + 1.0);
  }
  double at(double value) const { return from + (std::log10(value) - low) / (high - low) * (to - from); }
};

void drawAxes(std::ostream& svg, const Axis& x, const Axis& y) {
  for (double decade = x.low; decade <= x.high; ++decade)
    svg << "<path d='M" << x.at(std::pow(10, decade)) << ' ' << y.from << "V" << y.to << "' stroke='#ddd'/><text x='"
        << x.at(std::pow(10, decade)) << "' y='" << y.from + 18 << "' text-anchor='middle'>" << std::pow(10, decade)
        << "</text>\n";
  for (double decade = y.low; decade <= y.high; ++decade)
    svg << "<path d='M" << x.from << ' ' << y.at(std::pow(10, decade)) << "H" << x.to << "' stroke='#ddd'/><text x='"
        << x.from - 8 << "' y='" << y.at(std::pow(10, decade)) + 4 << "' text-anchor='end'>" << std::pow(10, decade)
        << "</text>\n";
  svg << "<text x='" << (x.from + x.to) / 2 << "' y='" << kHeight - 10
      << "' text-anchor='middle'>Gaussians of the scale</text>\n<text transform='translate(16 " << (y.from + y.to) / 2
      << ") rotate(-90)' text-anchor='middle'>distance of samples to the finest scale [m]</text>\n";
}

}  // namespace

void plotCurves(const Json& curves, const std::filesystem::path& path) {
  Axis x, y;
  for (const Json& curve : curves)
    for (const Json& point : curve.at("points")) {
      x.add(point.at("gaussians").get<double>());
      for (const char* const key : {"q95", "mean"}) y.add(std::max(point.at(key).get<double>(), 1e-9));
    }
  x.close();
  y.close();
  x.from = kLeft;
  x.to = kWidth - kRight;
  y.from = kHeight - kBottom;
  y.to = kTop;
  std::ostringstream svg;
  svg << "<svg xmlns='http://www.w3.org/2000/svg' width='" << kWidth << "' height='" << kHeight
      << "' font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' fill='white'/>\n";
  drawAxes(svg, x, y);
  double legend = kTop + 10;
  std::size_t number = 0;
  for (const Json& curve : curves) {
    const char* colour = kColours[number++ % std::size(kColours)];
    for (const char* const key : {"q95", "mean"}) {
      const bool dashed = std::string(key) == "mean";
      svg << "<polyline fill='none' stroke-width='2' stroke='" << colour << (dashed ? "' stroke-dasharray='5 4" : "")
          << "' points='";
      for (const Json& point : curve.at("points"))
        svg << x.at(point.at("gaussians").get<double>()) << ',' << y.at(std::max(point.at(key).get<double>(), 1e-9))
            << ' ';
      svg << "'/>\n<text fill='" << colour << "' x='" << x.to + 12 << "' y='" << legend << "'>scale "
          << curve.at("scale").get<int>() << (dashed ? ", mean (dashed)" : ", 95 %") << "</text>\n";
      legend += 18;
    }
  }
  svg << "</svg>\n";
  const std::string text = svg.str();
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace gaussmap::app
