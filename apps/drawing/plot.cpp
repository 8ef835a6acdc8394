// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/plot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "drawing/svg.h"

namespace gaussmap::app {
namespace {

constexpr double kWidth = 700, kHeight = 420, kLeft = 70, kRight = 250, kTop = 20, kBottom = 50;
constexpr const char* kCurveColours[] = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"};
constexpr double kSmallest = 1e-9;  // replaces zero on a logarithmic axis

/// An axis of the picture: the values at its ends, and their places [pixels].
class PictureAxis {
 public:
  PictureAxis(const PlotAxis& axis, double from, double to)
      : is_logarithmic_(axis.scale == AxisScale::Logarithmic), from_(from), to_(to) {}

  void add(double value) {
    low_ = std::min(low_, scaled(value));
    high_ = std::max(high_, scaled(value));
  }
  /// Extends the axis to round values. Call it after all values have been added.
  void close() {
    if (is_logarithmic_) {
      low_ = std::floor(low_);
      high_ = std::max(std::ceil(high_), low_ + 1.0);
      step_ = 1.0;
      return;
    }
    low_ = 0.0;
    if (!(high_ > 0.0)) high_ = 1.0;
    step_ = roundLength(high_ / 4.0);
    high_ = step_ * std::ceil(high_ / step_ - 1e-9);
  }
  double from() const { return from_; }
  double to() const { return to_; }
  double at(double value) const { return place(scaled(value)); }
  /// Calls body(value, place) for each labelled value.
  template <typename Body>
  void forTicks(const Body& body) const {
    const int count = static_cast<int>(std::lround((high_ - low_) / step_));
    for (int i = 0; i <= count; ++i) {
      const double tick = low_ + i * step_;
      body(is_logarithmic_ ? std::pow(10.0, tick) : tick, place(tick));
    }
  }

 private:
  double scaled(double value) const { return is_logarithmic_ ? std::log10(std::max(value, kSmallest)) : value; }
  double place(double scaled) const { return from_ + (scaled - low_) / (high_ - low_) * (to_ - from_); }

  bool is_logarithmic_;
  double from_, to_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
  double step_ = 1.0;
};

void drawAxes(Svg& svg, const LinePlot& plot, const PictureAxis& x, const PictureAxis& y) {
  x.forTicks([&](double value, double place) {
    svg << "<path d='M" << place << ' ' << y.from() << "V" << y.to() << "' stroke='#ddd'/>\n";
    svg.text(place, y.from() + 18, numberText(value), "text-anchor='middle'");
  });
  y.forTicks([&](double value, double place) {
    svg << "<path d='M" << x.from() << ' ' << place << "H" << x.to() << "' stroke='#ddd'/>\n";
    svg.text(x.from() - 8, place + 4, numberText(value), "text-anchor='end'");
  });
  svg.text((x.from() + x.to()) / 2, kHeight - 10, plot.x.title, "text-anchor='middle'");
  svg.text(-(y.from() + y.to()) / 2, 16, plot.y.title, "transform='rotate(-90)' text-anchor='middle'");
}

}  // namespace

void drawPlot(const LinePlot& plot, const std::filesystem::path& path) {
  PictureAxis x(plot.x, kLeft, kWidth - kRight), y(plot.y, kHeight - kBottom, kTop);
  for (const PlotLine& line : plot.lines)
    for (const Vector<2>& point : line.points) {
      x.add(point.x());
      y.add(point.y());
    }
  x.close();
  y.close();
  Svg svg(kWidth, kHeight);
  drawAxes(svg, plot, x, y);
  double legend = kTop + 10;
  for (const PlotLine& line : plot.lines) {
    const char* const colour = kCurveColours[static_cast<std::size_t>(line.colour) % std::size(kCurveColours)];
    svg << "<polyline fill='none' stroke-width='2' stroke='" << colour << (line.dashed ? "' stroke-dasharray='5 4" : "")
        << "' points='";
    for (const Vector<2>& point : line.points) svg << x.at(point.x()) << ',' << y.at(point.y()) << ' ';
    svg << "'/>\n";
    if (line.name.empty()) continue;
    svg.text(x.to() + 12, legend, line.name, std::string("fill='") + colour + "'");
    legend += 18;
  }
  svg.save(path);
}

void plotCurves(const std::vector<ErrorCurve>& curves, const std::filesystem::path& path) {
  LinePlot plot;
  plot.x = {"Gaussians of the scale", AxisScale::Logarithmic};
  plot.y = {"distance of samples to the finest scale [m]", AxisScale::Logarithmic};
  int number = 0;
  for (const ErrorCurve& curve : curves) {
    const std::string name = "scale " + std::to_string(curve.scale);
    PlotLine q95{name + ", 95 %", {}, number, false}, mean{name + ", mean (dashed)", {}, number, true};
    for (const ErrorPoint& point : curve.points) {
      q95.points.emplace_back(static_cast<double>(point.gaussians), point.q95);
      mean.points.emplace_back(static_cast<double>(point.gaussians), point.mean);
    }
    plot.lines.push_back(q95);
    plot.lines.push_back(mean);
    ++number;
  }
  drawPlot(plot, path);
}

}  // namespace gaussmap::app
