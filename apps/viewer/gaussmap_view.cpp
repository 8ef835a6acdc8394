// SPDX-License-Identifier: BSD-3-Clause
// gaussmap-view MAP [CLOUD...]: the program that `gaussmap view` starts.
#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>

#include "commands/scan_input.h"
#include "common/command.h"
#include "common/report.h"
#include "common/signals.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "viewer/viewer.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct ViewCommand {
  std::string map;
  ScanInput cloud;
  std::optional<int> scale;
  bool leaves = false;
  std::string colour;  // empty: the default
  std::string up = "z", from = "iso", size = "1200x800";
  std::vector<double> at;
  Output png;
  ViewOptions view;
};

const std::map<std::string, ColourBy> kColours = {{"scale", ColourBy::Scale},   {"height", ColourBy::Height},
                                                  {"normal", ColourBy::Normal}, {"weight", ColourBy::Weight},
                                                  {"error", ColourBy::Error},   {"occupancy", ColourBy::Occupancy}};
const std::map<std::string, Vector<3>> kUp = {{"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}},
                                              {"-x", {-1, 0, 0}}, {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};

/// Reads `count` numbers such as "1,2.5,-3" or "800x600". Returns an empty vector for any other text.
template <typename Number>
std::vector<Number> numbersIn(const std::string& text, char between, std::size_t count) {
  std::vector<Number> numbers;
  const char* place = text.data();
  const char* const end = place + text.size();
  while (numbers.size() < count) {
    Number number{};
    const auto [next, error] = std::from_chars(place, end, number);
    const bool is_last = numbers.size() + 1 == count;
    if (error != std::errc() || (is_last ? next != end : next == end || *next != between)) return {};
    numbers.push_back(number);
    place = is_last ? next : next + 1;
  }
  return numbers;
}

ViewPoint viewPoint(const ViewCommand& command, const Vector<3>& up) {
  if (command.from == "iso") return {};
  if (command.from == "top") return viewFromAbove(up);
  const std::vector<double> numbers = numbersIn<double>(command.from, ',', 3);
  ViewPoint view;
  if (!numbers.empty()) view.direction = {numbers[0], numbers[1], numbers[2]};
  if (numbers.empty() || !view.direction.allFinite() || !(view.direction.norm() > 1e-6))
    throw UsageError("--view " + command.from + ": expected top, iso, or a direction x,y,z such as -1,-2,1.5");
  return view;
}

std::pair<int, int> sizeOf(const ViewCommand& command) {
  const std::vector<int> numbers = numbersIn<int>(command.size, 'x', 2);
  for (const int number : numbers)
    if (number < 16 || number > 8192) throw UsageError("--size " + command.size + ": sides must be 16 to 8192 pixels");
  if (numbers.empty()) throw UsageError("--size " + command.size + ": expected two numbers, such as 1200x800");
  return {numbers[0], numbers[1]};
}

void checkForSegments(const ViewCommand& command) {
  for (const auto& [name, given] :
       {std::pair("--scale", command.scale.has_value()), std::pair("--leaves", command.leaves),
        std::pair("--color", !command.colour.empty()), std::pair("--cells", command.view.cells),
        std::pair("--hierarchy", command.view.hierarchy)})
    if (given) throw UsageError(std::string(name) + ": not for maps of segments, such as " + command.map);
}

/// Sets the scale that is shown, which depends on the map.
void setScale(const ViewCommand& command, const GaussianMap<3>& map, ViewOptions& view) {
  if (command.leaves && command.scale) throw UsageError("--leaves and --scale: only one of them may be given");
  if (command.scale) checkScale("--scale", *command.scale, map.scales());
  if (command.leaves) return;
  view.scale = command.scale.value_or(scaleToShow(map));
  if (view.colour == ColourBy::Error && *view.scale == 0 && command.cloud.paths.empty() && !view.hierarchy)
    throw UsageError(
        "--color error: no scale is finer than scale 0; give a CLOUD to compare with or a coarser --scale");
}

void run(ViewCommand command) {
  const auto [width, height] = sizeOf(command);
  ViewOptions view = command.view;
  view.up = kUp.at(command.up);
  const double zoom = view.view.zoom;
  view.view = viewPoint(command, view.up);
  view.view.zoom = zoom;
  if (!command.at.empty()) view.view.middle = Vector<3>(command.at[0], command.at[1], command.at[2]);
  if (!command.colour.empty()) view.colour = kColours.at(command.colour);
  if (!command.png.path.empty()) {
    requireExtension(command.png.path, ".png");
    checkOutput(command.png, {command.map});
  }
  ViewScene scene;
  scene.name = std::filesystem::path(command.map).filename().string();
  if (std::filesystem::exists(command.map) && !isGmap(command.map) && isSegmentPcd(command.map)) {
    checkForSegments(command);
    scene.map = loadSegmentsPcd(command.map);
  } else {
    GaussianMap<3> map = loadAny(command.map);
    if (map.empty()) throw std::runtime_error(command.map + ": the map is empty, so there is nothing to show");
    setScale(command, map, view);
    scene.map = std::move(map);
  }
  if (!command.cloud.paths.empty()) scene.cloud = readPoints(command.cloud, 0);
  Viewer viewer(std::move(scene), view);
  if (command.png.path.empty()) return viewer.show(width, height);
  viewer.savePng(command.png.path, width, height);
  std::cout << command.png.path << ": " << width << " x " << height << ", "
            << humanBytes(std::filesystem::file_size(command.png.path)) << '\n';
}

void addOptions(Command& command, ViewCommand& options) {
  command.text("map", options.map, "map (.gmap, or PCD of Gaussians or of segments)").required();
  command.texts("cloud", options.cloud.paths, "PCD files or directories, drawn over the map");
  addScanOptions(command, options.cloud);
  command.scale(options.scale, "scale to show, 0 = finest; default: the finest scale with at most 200,000 Gaussians");
  command.flag("--leaves", options.leaves, "show all leaves of a compressed map");
  command.choice("--color", options.colour, {"height", "scale", "normal", "weight", "occupancy", "error"},
                 "colour of the Gaussians, default: height; error = distance to CLOUD, or else to the finer scales");
  command.number("--sigma", options.view.sigma, 0.01, 100.0, "half axes of the ellipsoids, in standard deviations");
  command.flag("--cells", options.view.cells, "draw the occupied cells as boxes");
  command.flag("--hierarchy", options.view.hierarchy,
               "draw all scales, one above the other, with links to the children");
  command.choice("--up", options.up, Command::wordsOf(kUp), "axis that points up");
  command.text("--view", options.from, "top, iso, or the direction x,y,z from the map to the eye");
  command.number("--zoom", options.view.view.zoom, 0.01, 1000.0, "magnification, 1 = the whole map");
  command.numbers("--at", options.at, 3, -1e9, 1e9, "point to look at [m]; default: the middle of the map")
      .type("X Y Z");
  command.text("--png", options.png.path, "save a picture instead of opening a window; needs no display");
  command.text("--size", options.size, "size of the picture or window [pixels]");
  command.force(options.png.force, "replace an existing picture");
}

}  // namespace
}  // namespace gaussmap::app

int main(int argc, char** argv) {
  using namespace gaussmap::app;
  handleSignals("gaussmap");
  CLI::App app("", "gaussmap view");
  app.set_help_all_flag("--help-all", "show all options and the keys");
  Command command(app, {"Show a map in a window, or save a picture (--png)",
                        "gaussmap view street.gmap --scale 1 --color normal --png street.png --size 1600x900",
                        "Keys:\n" + gaussmap::Viewer::helpText()});
  ViewCommand options;
  addOptions(command, options);
  try {
    app.parse(argc, argv);
    run(options);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::cerr << "gaussmap: " << error.what() << " (see gaussmap view --help)\n";
    return 2;
  } catch (const UsageError& error) {
    std::cerr << "gaussmap: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "gaussmap: " << error.what() << '\n';
    return 1;
  }
}
