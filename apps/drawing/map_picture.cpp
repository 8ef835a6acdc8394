// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/map_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "drawing/plan_view.h"

namespace gaussmap::app {
namespace {

// Sizes in pixels.
constexpr double kRowWidth = 1200, kColumnHeight = 1500, kPanelHeight = 900;  // maximum
constexpr double kMargin = 12, kTitle = 16, kLegend = 44, kFont = 11;
constexpr double kCharacter = 6.2;  // upper bound of the mean width of a character
constexpr double kColourBar = 220, kMinWidth = 540;
constexpr double kThin = 2.0;  // thinner ellipses (poles, fronts) are filled, to be visible

/// Viridis (van der Walt and Smith 2015) in nine steps: equal differences look equal. The order is reversed, so the
/// ground is pale on white paper, and objects above it are dark.
constexpr int kScaleColours[][3] = {{253, 231, 37}, {173, 220, 48}, {94, 201, 98}, {40, 174, 128}, {33, 145, 140},
                                    {44, 114, 142}, {59, 82, 139},  {71, 45, 123}, {68, 1, 84}};

/// Returns the colour "#rrggbb" of a place from 0 (low) to 1 (high).
std::string colourOf(double place) {
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

/// The heights [m] of the first and the last colour.
struct HeightRange {
  double low, high;
  bool empty() const { return !(low < high); }  // no colour shows a height
  double placeOf(double height) const { return (height - low) / (high - low); }
};

HeightRange heightRange(const std::vector<Panel>& panels) {
  std::vector<double> tops;
  for (const Panel& panel : panels)
    for (const Ellipse& ellipse : panel.ellipses)
      if (ellipse.colour.empty()) tops.push_back(ellipse.top);
  if (tops.empty()) return {0.0, 0.0};
  std::sort(tops.begin(), tops.end());
  const std::size_t last = tops.size() - 1;
  const HeightRange range{tops[last / 100], tops[last - last / 100]};
  return range.high - range.low < 1e-3 ? HeightRange{range.low - 0.5, range.high + 0.5} : range;
}

/// Sizes and positions in the picture [pixels].
struct Layout {
  PlanView view;                 // of every panel
  double step_x, step_y;         // from one panel to the next
  double all_width, all_height;  // of the picture
};

Layout layOut(const std::vector<Panel>& panels, const Box<2>& window) {
  const Vector<2> size = window.high - window.low;
  const auto count = static_cast<double>(panels.size());
  const double row = std::min(kRowWidth / count / size.x(), kPanelHeight / size.y());
  const double column = std::min(kRowWidth / size.x(), kColumnHeight / count / size.y());
  const bool stacked = column > 1.5 * row;
  double title = 0.0;
  for (const Panel& panel : panels) title = std::max(title, kCharacter * static_cast<double>(panel.title.size()));

  Layout layout;
  layout.view = {window, stacked ? column : row};
  const double height = layout.view.height(), column_width = std::max(layout.view.width(), title);
  layout.step_x = stacked ? 0.0 : column_width + kMargin;
  layout.step_y = stacked ? kTitle + height + kMargin : 0.0;
  layout.all_width = std::max((count - 1) * layout.step_x + column_width, kMinWidth) + 2 * kMargin;
  layout.all_height = (count - 1) * layout.step_y + kTitle + height + 2 * kMargin + kLegend;
  return layout;
}

/// Draws the borders of the cells, unless they are so close that they would look like a grey area.
void drawGrid(Svg& svg, const PlanView& view, double side) {
  if (side * view.scale < 4.0) return;  // also without a grid
  const Box<2>& window = view.window;
  svg << "<path stroke='#d8d8d8' stroke-width='.6' d='";
  for (double k = std::ceil(window.low.x() / side); k * side <= window.high.x(); ++k)
    svg << 'M' << view.x(k * side) << " 0V" << view.height();
  for (double k = std::ceil(window.low.y() / side); k * side <= window.high.y(); ++k)
    svg << "M0 " << view.y(k * side) << 'H' << view.width();
  svg << "'/>\n";
}

void drawEllipse(Svg& svg, const PlanView& view, const HeightRange& heights, const Ellipse& ellipse) {
  const double x = view.x(ellipse.centre.x()), y = view.y(ellipse.centre.y());
  const double degrees = std::atan2(-ellipse.axis.y(), ellipse.axis.x()) * 180.0 / std::acos(-1.0);
  const bool thin = ellipse.width * view.scale < kThin;
  svg << "<ellipse cx='" << x << "' cy='" << y << "' rx='" << ellipse.axis.norm() * view.scale << "' ry='"
      << ellipse.width * view.scale << "' transform='rotate(" << degrees << ' ' << x << ' ' << y << ")' color='"
      << (ellipse.colour.empty() ? colourOf(heights.placeOf(ellipse.top)) : ellipse.colour)
      << (thin ? "' fill-opacity='.7'/>\n" : "'/>\n");
}

void drawSquares(Svg& svg, const PlanView& view, const std::vector<Box<2>>& squares) {
  if (squares.empty()) return;
  svg << "<path fill='none' stroke='black' stroke-width='.9' d='";
  for (const Box<2>& square : squares) {
    const Vector<2> size = (square.high - square.low) * view.scale;
    svg << 'M' << view.x(square.low.x()) << ' ' << view.y(square.high.y()) << 'h' << size.x() << 'v' << size.y() << 'h'
        << -size.x() << 'z';
  }
  svg << "'/>\n";
}

void drawPanel(Svg& svg, const PlanView& view, const HeightRange& heights, Panel& panel) {
  const auto area = [](const Ellipse& ellipse) { return ellipse.axis.norm() * ellipse.width; };
  std::stable_sort(panel.ellipses.begin(), panel.ellipses.end(),
                   [&](const Ellipse& a, const Ellipse& b) { return area(a) > area(b); });
  svg.text(0, kTitle - 5, panel.title);
  svg << "<g transform='translate(0 " << kTitle << ")'><g clip-path='url(#window)'>\n";
  drawGrid(svg, view, panel.cell_side);
  drawSquares(svg, view, panel.squares);
  svg << "<g fill='currentColor' fill-opacity='.16' stroke='currentColor' stroke-width='.7'>\n";
  for (const Ellipse& ellipse : panel.ellipses) drawEllipse(svg, view, heights, ellipse);
  svg << "</g></g>\n<rect width='" << view.width() << "' height='" << view.height()
      << "' fill='none' stroke='#999' stroke-width='.8'/></g>\n";
}

void drawKeys(Svg& svg, const std::vector<ColourKey>& keys, double right, double y) {
  double x = right;
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    x -= kCharacter * static_cast<double>(key->text.size());
    svg.text(x, y + 8, key->text);
    svg << "<rect x='" << x - 18 << "' y='" << y - 1 << "' width='12' height='9' fill='" << key->colour
        << "' fill-opacity='" << (key->is_outline ? "0" : ".25") << "' stroke='" << key->colour << "'/>\n";
    x -= 36;
  }
}

void drawColourBar(Svg& svg, const HeightRange& heights, double right, double y) {
  const double left = right - kColourBar;
  svg << "<linearGradient id='heights'>";
  for (std::size_t i = 0; i < std::size(kScaleColours); ++i) {
    const double place = static_cast<double>(i) / (std::size(kScaleColours) - 1);
    svg << "<stop offset='" << place << "' stop-color='" << colourOf(place) << "'/>";
  }
  svg << "</linearGradient>\n<rect x='" << left << "' y='" << y << "' width='" << kColourBar
      << "' height='8' fill='url(#heights)'/>\n";
  svg.text(left - 8, y + 8, "top of the ellipsoid [m]", "text-anchor='end'");
  const double step = roundLength((heights.high - heights.low) / 3);
  double end_of_label = 0.0;
  for (double k = std::ceil(heights.low / step); k * step <= heights.high; ++k) {
    const double x = left + heights.placeOf(k * step) * kColourBar;
    const std::string label = numberText(k * step + 0.0);  // "+ 0.0" turns -0 into 0
    const double half = kCharacter * static_cast<double>(label.size()) / 2;
    svg << "<path d='M" << x << ' ' << y + 8 << "v3' stroke='black'/>\n";
    if (x - half < end_of_label) continue;
    svg.text(x, y + 22, label, "text-anchor='middle'");
    end_of_label = x + half + 4;
  }
}

}  // namespace

Vector<2> Ellipse::reach() const {
  const Vector<2> side = Vector<2>(-axis.y(), axis.x()) * (width / axis.norm());  // the other half axis
  return {std::hypot(axis.x(), side.x()), std::hypot(axis.y(), side.y())};
}

Ellipse ellipseFromAbove(const Gaussian<3>& gaussian, double sigma) {
  const PrincipalAxes<2> axes =
      principalAxes<2>({gaussian.mean.head<2>(), gaussian.cov.topLeftCorner<2, 2>(), gaussian.weight});
  const Vector<2> lengths = sigma * axes.variances.cwiseMax(0.0).cwiseSqrt();
  return {gaussian.mean.head<2>(), lengths(1) * axes.directions.col(1), lengths(0),
          gaussian.mean.z() + sigma * std::sqrt(gaussian.cov(2, 2)), ""};
}

void drawMaps(std::vector<Panel> panels, const Box<2>& window, const std::filesystem::path& path) {
  const Layout layout = layOut(panels, window);
  const HeightRange heights = heightRange(panels);
  Svg svg(layout.all_width, layout.all_height, kFont);
  svg << "<clipPath id='window'><rect width='" << layout.view.width() << "' height='" << layout.view.height()
      << "'/></clipPath>\n";
  double x = kMargin, y = kMargin;
  for (Panel& panel : panels) {
    svg << "<g transform='translate(" << x << ' ' << y << ")'>\n";
    drawPanel(svg, layout.view, heights, panel);
    svg << "</g>\n";
    x += layout.step_x;
    y += layout.step_y;
  }
  const double legend = layout.all_height - kLegend + 4;
  layout.view.drawScaleBar(svg, kMargin, legend, std::max(layout.view.width(), kMinWidth) / 5);
  if (!heights.empty()) drawColourBar(svg, heights, layout.all_width - kMargin, legend);
  const auto with_keys =
      std::find_if(panels.begin(), panels.end(), [](const Panel& panel) { return !panel.keys.empty(); });
  if (with_keys != panels.end()) drawKeys(svg, with_keys->keys, layout.all_width - kMargin, legend);
  svg.save(path);
}

}  // namespace gaussmap::app
