// SPDX-License-Identifier: BSD-3-Clause
// gaussmap draw MAP... -o OUT.svg: draws the ellipses of maps, seen from above.
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "common/command.h"
#include "common/report.h"
#include "drawing/map_picture.h"
#include "drawing/plan_view.h"

namespace gaussmap::app {
namespace {

constexpr std::size_t kMaxEllipses = 200000;         // already 30 MB of text, which is the limit of many viewers
constexpr double kSigma = 2.0, kOverlaySigma = 3.0;  // default half axes [standard deviations]
constexpr const char *kPlanarColour = "#22488c", *kCoarseColour = "#1f4fd8", *kFineColour = "#d61f1f";

const Help kDrawHelp = {
    "Draw maps from above: the ellipses of one scale, coloured by height",
    "gaussmap draw one.gmap street.gmap -o street.svg --scale 2",
    R"(One panel per map, all drawn to the same scale. Each ellipse is the exact projection of an ellipsoid.
Planar maps have no heights, so their ellipses have one colour.

--overlay draws the coarsest scale (or that of --scale) in blue, the finest scale in red, and the cells of the coarse
scale as black squares, as in Fig. 7 of Yguel et al. 2009.)"};

struct DrawCommand {
  std::vector<std::string> maps;
  Output output;
  std::optional<int> scale;
  std::optional<double> sigma;
  bool overlay = false;
  std::vector<double> box;
};

std::optional<Box<2>> givenWindow(const std::vector<double>& box) {
  if (box.empty()) return {};
  if (!(box[0] < box[2] && box[1] < box[3]))
    throw UsageError("--box: the second corner must be right of and above the first");
  return Box<2>{{box[0], box[1]}, {box[2], box[3]}};
}

/// "scale 2 (10 m), 40 Gaussians"
std::string titleOf(const GaussianMap<3>& map, int scale) {
  return "scale " + std::to_string(scale) + " (" + numberText(map.grid().side(scale)) + " m), " +
         std::to_string(map.gaussianCount(scale)) + " Gaussians";
}

/// Adds the ellipses of a scale. An empty colour means the colour of the height.
void addEllipses(const GaussianMap<3>& map, int scale, double sigma, const std::string& colour, Panel& panel) {
  panel.ellipses.reserve(panel.ellipses.size() + map.gaussianCount(scale));
  for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
    panel.ellipses.push_back(ellipseFromAbove(map.gaussian(i, scale), sigma));
    panel.ellipses.back().colour = colour;
  }
}

/// Returns the squares of the cells of a scale, seen from above, each once [m].
std::vector<Box<2>> squaresOf(const GaussianMap<3>& map, int scale) {
  std::set<std::pair<std::int32_t, std::int32_t>> keys;
  for (const CellKey<3>& key : map.scale(scale).keys) keys.emplace(key[0], key[1]);
  std::vector<Box<2>> squares;
  squares.reserve(keys.size());
  const double side = map.grid().side(scale);
  for (const auto& [x, y] : keys) squares.push_back({Vector<2>(x, y) * side, Vector<2>(x + 1.0, y + 1.0) * side});
  return squares;
}

Panel panelOf(const std::string& path, const DrawCommand& options) {
  const bool is_planar = dimensionsOf(path) == 2;
  const GaussianMap<3> map = loadInSpace(path);
  const int scale = options.scale.value_or(map.scales() - 1);
  checkScale("--scale", scale, map.scales(), path);
  Panel panel;
  panel.title = std::filesystem::path(path).filename().string() + ": " + titleOf(map, scale);
  if (!options.overlay) {
    panel.cell_side = map.grid().side(scale);
    addEllipses(map, scale, options.sigma.value_or(kSigma), is_planar ? kPlanarColour : "", panel);
    return panel;
  }
  if (scale == 0)
    throw UsageError(path + ": --overlay draws a coarse scale over the finest one; use --scale 1 or more");
  const double sigma = options.sigma.value_or(kOverlaySigma);
  panel.title += " over " + titleOf(map, 0);
  panel.squares = squaresOf(map, scale);
  panel.keys = {
      {kCoarseColour, "coarse scale", false}, {kFineColour, "finest scale", false}, {"#000000", "coarse cells", true}};
  addEllipses(map, scale, sigma, kCoarseColour, panel);
  addEllipses(map, 0, sigma, kFineColour, panel);
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
  for (const Panel& panel : panels)
    for (const Box<2>& square : panel.squares) {
      include(window, square.low);
      include(window, square.high);
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
  command.number("--sigma", options->sigma, 0.01, 100.0,
                 "half axes of the ellipses, in standard deviations; default: 2, with --overlay 3");
  command.flag("--overlay", options->overlay, "draw the coarsest and the finest scale over each other, and the cells");
  command.numbers("--box", options->box, 4, -1e9, 1e9, "draw only the part from x0 y0 to x1 y1 [m]")
      .type("X0 Y0 X1 Y1");
  command.files({"maps"}, {".gmap", ".pcd"});
  command.files({"--output"}, {".svg"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
