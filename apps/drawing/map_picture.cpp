// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/map_picture.h"

#include <algorithm>
#include <cmath>

#include "drawing/colour_scale.h"
#include "drawing/plan_view.h"

namespace gaussmap::app {
namespace {

// Sizes in pixels.
constexpr double kRowWidth = 1200, kColumnHeight = 1500, kPanelHeight = 900;  // maximum
constexpr double kMargin = 12, kTitle = 16, kLegend = 44, kLegendGap = 24, kFont = 11;
constexpr double kMinWidth = 540;
constexpr double kThin = 2.0;  // thinner ellipses (poles, fronts) are filled, to be visible

/// Returns the colours of all values in the panels.
ColourScale colourScaleOf(const std::vector<Panel>& panels, const BarOptions& bar) {
  std::vector<double> values;
  for (const Panel& panel : panels) {
    for (const Ellipse& ellipse : panel.ellipses)
      if (ellipse.colour.empty()) values.push_back(ellipse.value);
    for (const Square& square : panel.squares)
      if (square.value) values.push_back(*square.value);
  }
  return colourScale(bar.title, values, bar.is_logarithmic);
}

/// Sizes and positions in the picture [pixels].
struct Layout {
  PlanView view;                 // of every panel
  double step_x, step_y;         // from one panel to the next
  double all_width, all_height;  // of the picture
};

Layout layOut(const std::vector<Panel>& panels, const Box<2>& window, double bar_width) {
  const Vector<2> size = window.high - window.low;
  const auto count = static_cast<double>(panels.size());
  const double row = std::min(kRowWidth / count / size.x(), kPanelHeight / size.y());
  const double column = std::min(kRowWidth / size.x(), kColumnHeight / count / size.y());
  const bool stacked = column > 1.5 * row;
  double title = 0.0;
  for (const Panel& panel : panels) title = std::max(title, widthOf(panel.title));

  Layout layout;
  layout.view = {window, stacked ? column : row};
  const double height = layout.view.height(), column_width = std::max(layout.view.width(), title);
  layout.step_x = stacked ? 0.0 : column_width + kMargin;
  layout.step_y = stacked ? kTitle + height + kMargin : 0.0;
  const double legend = std::max(kMinWidth, bar_width + kLegendGap + kMinWidth / 5);  // with the scale bar
  layout.all_width = std::max((count - 1) * layout.step_x + column_width, legend) + 2 * kMargin;
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

void drawEllipse(Svg& svg, const PlanView& view, const ColourScale& colours, const Ellipse& ellipse) {
  const double x = view.x(ellipse.centre.x()), y = view.y(ellipse.centre.y());
  const double degrees = std::atan2(-ellipse.axis.y(), ellipse.axis.x()) * 180.0 / std::acos(-1.0);
  const bool thin = ellipse.width * view.scale < kThin;
  svg << "<ellipse cx='" << x << "' cy='" << y << "' rx='" << ellipse.axis.norm() * view.scale << "' ry='"
      << ellipse.width * view.scale << "' transform='rotate(" << degrees << ' ' << x << ' ' << y << ")' color='"
      << (ellipse.colour.empty() ? colours.colourOf(ellipse.value) : ellipse.colour)
      << (thin ? "' fill-opacity='.7'/>\n" : "'/>\n");
}

void drawSquares(Svg& svg, const PlanView& view, const ColourScale& colours, double opacity,
                 const std::vector<Square>& squares) {
  if (squares.empty()) return;
  for (const Square& square : squares) {
    const Vector<2> size = (square.box.high - square.box.low) * view.scale;
    if (square.value)
      svg << "<rect x='" << view.x(square.box.low.x()) << "' y='" << view.y(square.box.high.y()) << "' width='"
          << size.x() << "' height='" << size.y() << "' fill='" << colours.colourOf(*square.value) << "' fill-opacity='"
          << opacity << "'/>\n";
  }
  svg << "<path fill='none' stroke='black' stroke-width='.9' d='";
  for (const Square& square : squares) {
    const Vector<2> size = (square.box.high - square.box.low) * view.scale;
    svg << 'M' << view.x(square.box.low.x()) << ' ' << view.y(square.box.high.y()) << 'h' << size.x() << 'v' << size.y()
        << 'h' << -size.x() << 'z';
  }
  svg << "'/>\n";
}

void drawPanel(Svg& svg, const PlanView& view, const ColourScale& colours, double opacity, Panel& panel) {
  const auto area = [](const Ellipse& ellipse) { return ellipse.axis.norm() * ellipse.width; };
  std::stable_sort(panel.ellipses.begin(), panel.ellipses.end(), [&](const Ellipse& a, const Ellipse& b) {
    return panel.has_large_on_top ? area(a) < area(b) : area(a) > area(b);
  });
  svg.text(0, kTitle - 5, panel.title);
  svg << "<g transform='translate(0 " << kTitle << ")'><g clip-path='url(#window)'>\n";
  drawGrid(svg, view, panel.cell_side);
  drawSquares(svg, view, colours, opacity, panel.squares);
  svg << "<g fill='currentColor' fill-opacity='" << (panel.is_filled ? ".16" : "0")
      << "' stroke='currentColor' stroke-width='.7'>\n";
  for (const Ellipse& ellipse : panel.ellipses) drawEllipse(svg, view, colours, ellipse);
  svg << "</g></g>\n<rect width='" << view.width() << "' height='" << view.height()
      << "' fill='none' stroke='#999' stroke-width='.8'/></g>\n";
}

void drawKeys(Svg& svg, const std::vector<ColourKey>& keys, double right, double y) {
  double x = right;
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    x -= widthOf(key->text);
    svg.text(x, y + 8, key->text);
    svg << "<rect x='" << x - 18 << "' y='" << y - 1 << "' width='12' height='9' fill='" << key->colour
        << "' fill-opacity='" << (key->is_outline ? "0" : ".25") << "' stroke='" << key->colour << "'/>\n";
    x -= 36;
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

void drawMaps(std::vector<Panel> panels, const Box<2>& window, const BarOptions& bar,
              const std::filesystem::path& path) {
  const ColourScale colours = colourScaleOf(panels, bar);
  const Layout layout = layOut(panels, window, colours.empty() ? 0.0 : colours.width());
  Svg svg(layout.all_width, layout.all_height, kFont);
  svg << "<clipPath id='window'><rect width='" << layout.view.width() << "' height='" << layout.view.height()
      << "'/></clipPath>\n";
  double x = kMargin, y = kMargin;
  for (Panel& panel : panels) {
    svg << "<g transform='translate(" << x << ' ' << y << ")'>\n";
    drawPanel(svg, layout.view, colours, bar.opacity, panel);
    svg << "</g>\n";
    x += layout.step_x;
    y += layout.step_y;
  }
  const double legend = layout.all_height - kLegend + 4;
  layout.view.drawScaleBar(svg, kMargin, legend, std::max(layout.view.width(), kMinWidth) / 5);
  if (!colours.empty()) colours.draw(svg, layout.all_width - kMargin, legend, bar.opacity);
  const auto with_keys =
      std::find_if(panels.begin(), panels.end(), [](const Panel& panel) { return !panel.keys.empty(); });
  if (with_keys != panels.end()) drawKeys(svg, with_keys->keys, layout.all_width - kMargin, legend);
  svg.save(path);
}

}  // namespace gaussmap::app
