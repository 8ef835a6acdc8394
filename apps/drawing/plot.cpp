// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "drawing/svg.h"

namespace gaussmap::app {
namespace {

constexpr double kWidth = 640, kHeight = 420, kLeft = 70, kRight = 190, kTop = 20, kBottom = 50;
constexpr const char* kCurveColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"};

/// A logarithmic axis that begins and ends at powers of ten.
struct Axis {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;  // values; powers of ten after close()
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

void drawAxes(Svg& svg, const Axis& x, const Axis& y) {
  for (int decade = int(x.low); decade <= int(x.high); ++decade) {
    const double value = std::pow(10, decade);
    svg << "<path d='M" << x.at(value) << ' ' << y.from << "V" << y.to << "' stroke='#ddd'/>\n";
    svg.text(x.at(value), y.from + 18, numberText(value), "text-anchor='middle'");
  }
  for (int decade = int(y.low); decade <= int(y.high); ++decade) {
    const double value = std::pow(10, decade);
    svg << "<path d='M" << x.from << ' ' << y.at(value) << "H" << x.to << "' stroke='#ddd'/>\n";
    svg.text(x.from - 8, y.at(value) + 4, numberText(value), "text-anchor='end'");
  }
  svg.text((x.from + x.to) / 2, kHeight - 10, "Gaussians of the scale", "text-anchor='middle'");
  svg.text(-(y.from + y.to) / 2, 16, "distance of samples to the finest scale [m]",
           "transform='rotate(-90)' text-anchor='middle'");
}

}  // namespace

void plotCurves(const std::vector<ErrorCurve>& curves, const std::filesystem::path& path) {
  constexpr double kMinError = 1e-9;  // [m]; replaces zero, which has no logarithm
  Axis x, y;
  for (const ErrorCurve& curve : curves)
    for (const ErrorPoint& point : curve.points) {
      x.add(static_cast<double>(point.gaussians));
      for (const double error : {point.q95, point.mean}) y.add(std::max(error, kMinError));
    }
  x.close();
  y.close();
  x.from = kLeft;
  x.to = kWidth - kRight;
  y.from = kHeight - kBottom;
  y.to = kTop;
  Svg svg(kWidth, kHeight);
  drawAxes(svg, x, y);
  double legend = kTop + 10;
  std::size_t number = 0;
  for (const ErrorCurve& curve : curves) {
    const char* colour = kCurveColours[number++ % std::size(kCurveColours)];
    for (const bool is_mean : {false, true}) {
      svg << "<polyline fill='none' stroke-width='2' stroke='" << colour << (is_mean ? "' stroke-dasharray='5 4" : "")
          << "' points='";
      for (const ErrorPoint& point : curve.points)
        svg << x.at(static_cast<double>(point.gaussians)) << ','
            << y.at(std::max(is_mean ? point.mean : point.q95, kMinError)) << ' ';
      svg << "'/>\n";
      svg.text(x.to + 12, legend, "scale " + std::to_string(curve.scale) + (is_mean ? ", mean (dashed)" : ", 95 %"),
               std::string("fill='") + colour + "'");
      legend += 18;
    }
  }
  svg.save(path);
}

}  // namespace gaussmap::app
