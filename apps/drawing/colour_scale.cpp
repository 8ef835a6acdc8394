// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/colour_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <tuple>
#include <utility>

#include "io/export/colours.h"

namespace gaussmap::app {
namespace {

constexpr double kBarWidth = 220, kBarHeight = 8, kTitleGap = 8;  // [pixels]
constexpr double kOverhang = 12;                                  // of the last number beyond the bar [pixels]
constexpr double kLeastSpan = 1e-3;                               // between the ends of a linear scale
constexpr const char* kNoValue = "#969696";

/// Viridis (van der Walt and Smith 2015) in nine steps: equal differences look equal. The order is reversed, so low
/// values (the ground) are pale on white paper, and high ones are dark.
constexpr int kScaleColours[][3] = {{253, 231, 37}, {173, 220, 48}, {94, 201, 98}, {40, 174, 128}, {33, 145, 140},
                                    {44, 114, 142}, {59, 82, 139},  {71, 45, 123}, {68, 1, 84}};

/// Returns the colour "#rrggbb" of a place from 0 (low) to 1 (high).
std::string colourAt(double place) {
  const double step = std::clamp(place, 0.0, 1.0) * (std::size(kScaleColours) - 1);
  const auto below = std::min(static_cast<std::size_t>(step), std::size(kScaleColours) - 2);
  const double part = step - static_cast<double>(below);
  long rgb[3];
  for (int i = 0; i < 3; ++i)
    rgb[i] = std::lround((1.0 - part) * kScaleColours[below][i] + part * kScaleColours[below + 1][i]);
  char text[32];
  std::snprintf(text, sizeof text, "#%02lx%02lx%02lx", rgb[0], rgb[1], rgb[2]);
  return text;
}

/// Returns the place of a value on the scale: 0 at its lower end, 1 at its upper end.
double placeOf(const ColourScale& scale, double value) {
  if (scale.is_logarithmic) {
    if (value <= 0.0) return 0.0;
    return std::log(value / scale.low) / std::log(scale.high / scale.low);
  }
  return (value - scale.low) / (scale.high - scale.low);
}

/// Returns the numbers that are written at the bar.
std::vector<double> marksOf(const ColourScale& scale) {
  std::vector<double> marks;
  if (!scale.is_logarithmic) {
    const double step = roundLength((scale.high - scale.low) / 3);
    for (double k = std::ceil(scale.low / step); k * step <= scale.high; ++k)
      marks.push_back(k * step + 0.0);  // "+ 0.0" turns -0 into 0
    return marks;
  }
  const bool only_decades = scale.high / scale.low > 50.0;
  const auto powerOf = [](double value) { return static_cast<int>(std::floor(std::log10(value))); };
  for (int power = powerOf(scale.low); power <= powerOf(scale.high); ++power)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double mark = step * std::pow(10.0, power);
      if ((step == 1.0 || !only_decades) && mark >= scale.low && mark <= scale.high) marks.push_back(mark);
    }
  return marks;
}

}  // namespace

std::string ColourScale::colourOf(double value) const {
  return std::isnan(value) ? kNoValue : colourAt(placeOf(*this, value));
}

double ColourScale::width() const {
  return kBarWidth + kTitleGap + widthOf(title);
}

void ColourScale::draw(Svg& svg, double right, double top, double opacity) const {
  const double left = right - kBarWidth;
  svg << "<linearGradient id='heights'>";
  for (std::size_t i = 0; i < std::size(kScaleColours); ++i) {
    const double place = static_cast<double>(i) / (std::size(kScaleColours) - 1);
    svg << "<stop offset='" << place << "' stop-color='" << colourAt(place) << "'/>";
  }
  svg << "</linearGradient>\n<rect x='" << left << "' y='" << top << "' width='" << kBarWidth << "' height='"
      << kBarHeight << "' fill='url(#heights)'";
  if (opacity < 1.0) svg << " fill-opacity='" << opacity << "'";
  svg << "/>\n";
  svg.text(left - kTitleGap, top + kBarHeight, title, "text-anchor='end'");
  double end_of_label = 0.0;
  for (const double mark : marksOf(*this)) {
    const double x = left + placeOf(*this, mark) * kBarWidth;
    const std::string label = numberText(mark);
    const double half = widthOf(label) / 2, middle = std::min(x, right + kOverhang - half);
    svg << "<path d='M" << x << ' ' << top + kBarHeight << "v3' stroke='black'/>\n";
    if (middle - half < end_of_label) continue;
    svg.text(middle, top + kBarHeight + 14, label, "text-anchor='middle'");
    end_of_label = middle + half + 4;
  }
}

ColourScale colourScale(const std::string& title, const std::vector<double>& values, bool is_logarithmic) {
  ColourScale scale;
  scale.title = title;
  scale.is_logarithmic = is_logarithmic;
  const auto isFinite = [](double value) { return std::isfinite(value); };
  if (std::none_of(values.begin(), values.end(), isFinite)) return scale;
  std::tie(scale.low, scale.high) = is_logarithmic ? detail::logColourRange(values) : detail::colourRange(values);
  if (scale.high - scale.low < kLeastSpan && !is_logarithmic)
    std::tie(scale.low, scale.high) = std::make_pair(scale.low - 0.5, scale.high + 0.5);
  return scale;
}

}  // namespace gaussmap::app
