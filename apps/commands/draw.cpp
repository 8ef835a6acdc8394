// SPDX-License-Identifier: BSD-3-Clause
// gaussmap draw MAP... -o OUT.svg: draws the ellipses of maps, seen from above.
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "commands/commands.h"
#include "common/command.h"
#include "common/report.h"
#include "drawing/map_picture.h"
#include "drawing/plan_view.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
namespace {

constexpr std::size_t kMaxEllipses = 200000;  // already 30 MB of text, which is the limit of many viewers

const Help kDrawHelp = {
    "Draw maps from above: the ellipses of one scale, coloured by height",
    "gaussmap draw one.gmap street.gmap -o street.svg --scale 2",
    R"(One panel per map, all drawn to the same scale. Each ellipse is the exact projection of an ellipsoid.)"};

struct DrawCommand {
  std::vector<std::string> maps;
  Output output;
  std::optional<int> scale;
  double sigma = 2.0;
  std::vector<double> box;
};

std::optional<Box<2>> givenWindow(const std::vector<double>& box) {
  if (box.empty()) return {};
  if (!(box[0] < box[2] && box[1] < box[3]))
    throw UsageError("--box: the second corner must be right of and above the first");
  return Box<2>{{box[0], box[1]}, {box[2], box[3]}};
}

Panel panelOf(const std::string& path, const DrawCommand& options) {
  const GaussianMap<3> map = loadAny(path);
  const int scale = options.scale.value_or(map.scales() - 1);
  checkScale("--scale", scale, map.scales(), path);
  const std::size_t count = map.gaussianCount(scale);
  Panel panel;
  panel.cell_side = map.grid().side(scale);
  panel.title = std::filesystem::path(path).filename().string() + ": scale " + std::to_string(scale) + " (" +
                numberText(panel.cell_side) + " m), " + std::to_string(count) + " Gaussians";
  panel.ellipses.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    panel.ellipses.push_back(ellipseFromAbove(map.gaussian(i, scale), options.sigma));
  return panel;
}

/// Returns the box around all ellipses [m].
Box<2> windowAround(const std::vector<Panel>& panels) {
  Box<2> window = emptyBox();
  for (const Panel& panel : panels)
    for (const Ellipse& ellipse : panel.ellipses) {
      include(window, ellipse.centre - ellipse.reach());
      include(window, ellipse.centre + ellipse.reach());
    }
  return window;
}

void removeOutside(std::vector<Ellipse>& ellipses, const Box<2>& window) {
  const auto isOutside = [&](const Ellipse& ellipse) {
    const Vector<2> low = ellipse.centre - ellipse.reach(), high = ellipse.centre + ellipse.reach();
    return (high.array() < window.low.array()).any() || (low.array() > window.high.array()).any();
  };
  ellipses.erase(std::remove_if(ellipses.begin(), ellipses.end(), isOutside), ellipses.end());
}

void run(const DrawCommand& options) {
  requireExtension(options.output.path, ".svg");
  checkOutput(options.output, {options.maps.begin(), options.maps.end()});
  const std::optional<Box<2>> given = givenWindow(options.box);
  std::vector<Panel> panels;
  for (const std::string& path : options.maps) panels.push_back(panelOf(path, options));
  std::size_t count = 0;
  for (Panel& panel : panels) {
    if (given) removeOutside(panel.ellipses, *given);
    count += panel.ellipses.size();
  }
  if (count == 0) throw std::runtime_error(options.maps.front() + ": no Gaussian lies in the picture");
  if (count > kMaxEllipses)
    throw UsageError(std::to_string(count) + " Gaussians would lie in the picture, more than " +
                     std::to_string(kMaxEllipses) + "; use a coarser --scale or draw a part of the map (--box)");
  const Box<2> window = given ? *given : windowAround(panels);
  drawMaps(std::move(panels), window, options.output.path);
  std::cout << options.output.path << ": " << count << " Gaussians, "
            << humanBytes(std::filesystem::file_size(options.output.path)) << '\n';
}

}  // namespace

void addDraw(CLI::App& app) {
  auto options = std::make_shared<DrawCommand>();
  Command command(app, "draw", kDrawHelp);
  command.texts("maps", options->maps, "maps (.gmap, or PCD of Gaussians)").required();
  command.output(options->output, "picture to write (.svg)");
  command.scale(options->scale, "scale to draw, 0 = finest; default: the coarsest");
  command.number("--sigma", options->sigma, 0.01, 100.0, "half axes of the ellipses, in standard deviations");
  command.numbers("--box", options->box, 4, -1e9, 1e9, "draw only the part from x0 y0 to x1 y1 [m]")
      .type("X0 Y0 X1 Y1");
  command.files({"maps"}, {".gmap", ".pcd"});
  command.files({"--output"}, {".svg"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
