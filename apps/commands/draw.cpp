// SPDX-License-Identifier: BSD-3-Clause
// gaussmap draw MAP... -o OUT.svg: draws the ellipses of maps, seen from above.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "common/command.h"
#include "common/report.h"
#include "drawing/map_picture.h"
#include "drawing/plan_view.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap::app {
namespace {

constexpr std::size_t kMaxEllipses = 200000;         // already 30 MB of text, which is the limit of many viewers
constexpr double kSigma = 2.0, kOverlaySigma = 3.0;  // default half axes [standard deviations]
constexpr double kSquareOpacity = 0.7;               // the ellipses stay visible on dark squares
constexpr const char *kPlanarColour = "#22488c", *kCoarseColour = "#1f4fd8", *kFineColour = "#d61f1f",
                     *kOnSquares = "#202020";

const Help kDrawHelp = {
    "Draw maps from above: the ellipses of one scale, coloured by height",
    "gaussmap draw one.gmap street.gmap -o street.svg --scale 2",
    R"(One panel per map, all drawn to the same scale. Each ellipse is the exact projection of an ellipsoid.
Planar maps have no heights, so their ellipses have one colour.

--overlay draws the coarsest scale (or that of --scale) in blue, the finest scale in red, and the cells of the coarse
scale as black squares, as in Fig. 7 of Yguel et al. 2009.

--color contribution and --color cell-error show where a coarse scale represents the finer one badly, by eq. (6) and
Fig. 5 of that paper. A finer Gaussian contributes the square of the distance between its mean and the nearest mean of
the coarse cell, in standard deviations of the finer Gaussian. The error of a cell is the mean of these contributions.
contribution colours the Gaussians of --scale (default: the second coarsest) and draws the cells of the next coarser
scale in black. cell-error colours the cells of --scale (default: the coarsest); of cells one above the other, it shows
the largest error.)"};

enum class DrawColour { Height, Contribution, CellError };
const std::map<std::string, DrawColour> kDrawColours = {
    {"height", DrawColour::Height}, {"contribution", DrawColour::Contribution}, {"cell-error", DrawColour::CellError}};

struct DrawCommand {
  std::vector<std::string> maps;
  Output output;
  std::optional<int> scale;
  std::optional<double> sigma;
  bool overlay = false;
  DrawColour colour = DrawColour::Height;
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

/// Returns the squares of the cells of a scale, seen from above, each once. `values`: one per cell, or empty; a square
/// has the largest value of its cells, or NaN if none has a value.
std::vector<Square> squaresOf(const GaussianMap<3>& map, int scale, const std::vector<double>& values = {}) {
  std::map<std::pair<std::int32_t, std::int32_t>, double> columns;
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) {
    const CellKey<3>& key = map.scale(scale).keys[cell];
    double& value = columns.try_emplace({key[0], key[1]}, std::numeric_limits<double>::quiet_NaN()).first->second;
    if (!values.empty()) value = std::fmax(value, values[cell]);  // NaN only if both are
  }
  std::vector<Square> squares;
  squares.reserve(columns.size());
  const double side = map.grid().side(scale);
  for (const auto& [column, value] : columns) {
    const Vector<2> low(column.first, column.second);
    squares.push_back({{low * side, (low + Vector<2>::Ones()) * side}, {}});
    if (!values.empty()) squares.back().value = value;
  }
  return squares;
}

/// Adds a coarse scale, the finest scale and the coarse cells. From above, the finest Gaussians of a map in space cover
/// the whole ground, so the coarse ones, which are translucent, lie on top.
void addOverlay(const GaussianMap<3>& map, bool is_planar, int scale, double sigma, Panel& panel) {
  panel.title += " over " + titleOf(map, 0);
  panel.squares = squaresOf(map, scale);
  panel.has_large_on_top = !is_planar;
  panel.keys = {
      {kCoarseColour, "coarse scale", false}, {kFineColour, "finest scale", false}, {"#000000", "coarse cells", true}};
  addEllipses(map, scale, sigma, kCoarseColour, panel);
  addEllipses(map, 0, sigma, kFineColour, panel);
}

/// Adds the Gaussians of a scale, coloured by their contribution to the errors of the next coarser one.
void addContributions(const GaussianMap<3>& map, int scale, double sigma, Panel& panel) {
  const std::vector<double> contributions = cellErrors(map, scale + 1).contributions;
  panel.title += ", cells of " + numberText(map.grid().side(scale + 1)) + " m";
  panel.squares = squaresOf(map, scale + 1);
  addEllipses(map, scale, sigma, "", panel);
  for (std::size_t i = 0; i < contributions.size(); ++i) panel.ellipses[i].value = contributions[i];
}

/// Adds the cells of a scale, coloured by their errors, and its Gaussians.
void addCellErrors(const GaussianMap<3>& map, int scale, double sigma, Panel& panel) {
  panel.squares = squaresOf(map, scale, cellErrors(map, scale).cells);
  addEllipses(map, scale, sigma, kOnSquares, panel);
  panel.is_filled = false;
}

/// Returns the scale to draw: that of --scale, or the default of the colour. Throws UsageError if the map does not have
/// it.
int scaleOf(const std::string& path, const GaussianMap<3>& map, const DrawCommand& options) {
  const int coarsest = map.scales() - 1, scale = options.scale.value_or(coarsest);
  checkScale("--scale", scale, map.scales(), path);
  if (options.overlay && scale == 0)
    throw UsageError(path + ": --overlay draws a coarse scale over the finest one; use --scale 1 or more");
  if (options.colour == DrawColour::CellError && scale == 0)
    throw UsageError(path + ": --color cell-error: no scale is finer than scale 0; use --scale 1 or more");
  if (options.colour != DrawColour::Contribution) return scale;
  if (options.scale ? scale == coarsest : coarsest == 0)
    throw UsageError(path + ": --color contribution: no scale is coarser than scale " + std::to_string(coarsest) +
                     (coarsest > 0 ? "; use a finer --scale" : ""));
  return options.scale.value_or(coarsest - 1);
}

Panel panelOf(const std::string& path, const DrawCommand& options) {
  const bool is_planar = dimensionsOf(path) == 2;
  const GaussianMap<3> map = loadInSpace(path);
  const int scale = scaleOf(path, map, options);
  const double sigma = options.sigma.value_or(options.overlay ? kOverlaySigma : kSigma);
  Panel panel;
  panel.title = std::filesystem::path(path).filename().string() + ": " + titleOf(map, scale);
  if (options.overlay) {
    addOverlay(map, is_planar, scale, sigma, panel);
  } else if (options.colour == DrawColour::Contribution) {
    addContributions(map, scale, sigma, panel);
  } else if (options.colour == DrawColour::CellError) {
    addCellErrors(map, scale, sigma, panel);
  } else {
    panel.cell_side = map.grid().side(scale);
    addEllipses(map, scale, sigma, is_planar ? kPlanarColour : "", panel);
  }
  return panel;
}

BarOptions barOf(DrawColour colour) {
  if (colour == DrawColour::Contribution)
    return {"contribution to the error of the coarse cell [squared sigma]", true, 1.0};
  if (colour == DrawColour::CellError) return {"error of the cell [squared sigma]", true, kSquareOpacity};
  return {};
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
    for (const Square& square : panel.squares) {
      include(window, square.box.low);
      include(window, square.box.high);
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
  drawMaps(std::move(panels), window, barOf(options.colour), options.output.path);
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
  command
      .choiceOf("--color", options->colour, kDrawColours,
                "colour by height, contribution of a Gaussian to the error of its coarse cell, or error of a cell")
      .rare();
  command.excludes("--overlay", {"--color"});
  command.numbers("--box", options->box, 4, -1e9, 1e9, "draw only the part from x0 y0 to x1 y1 [m]")
      .type("X0 Y0 X1 Y1");
  command.files({"maps"}, {".gmap", ".pcd"});
  command.files({"--output"}, {".svg"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
