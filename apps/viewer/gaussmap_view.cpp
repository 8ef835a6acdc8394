// SPDX-License-Identifier: BSD-3-Clause
// gaussmap-view MAP [CLOUD...]: the program that `gaussmap view` starts.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>

#include "commands/any_map.h"
#include "commands/scan_input.h"
#include "commands/view_options.h"
#include "common/report.h"
#include "common/signals.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "viewer/viewer.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const std::map<std::string, ColourBy> kColours = {{"scale", ColourBy::Scale},
                                                  {"height", ColourBy::Height},
                                                  {"normal", ColourBy::Normal},
                                                  {"weight", ColourBy::Weight},
                                                  {"error", ColourBy::Error},
                                                  {"occupancy", ColourBy::Occupancy},
                                                  {"contribution", ColourBy::Contribution},
                                                  {"cell-error", ColourBy::CellError}};

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

bool isMesh(const std::string& path) {
  return std::filesystem::path(path).extension() == ".ply";
}

bool isPlanar(const std::string& path) {
  return !isMesh(path) && dimensionsOf(path) == 2;
}

ViewPoint viewPoint(const ViewCommand& command, const Vector<3>& up) {
  const bool is_default = command.from.empty();
  const bool is_flat = !command.view.hierarchy && isPlanar(command.map);
  if (command.from == "top" || (is_default && is_flat)) return viewFromAbove(up);
  if (command.from == "iso" || is_default) return {};
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

/// Throws UsageError if an option was given that is only for maps of Gaussians.
void checkWithoutGaussians(const ViewCommand& command, const std::string& kind) {
  for (const auto& [name, given] :
       {std::pair("--scale", command.scale.has_value()), std::pair("--leaves", command.leaves),
        std::pair("--color", !command.colour.empty()), std::pair("--cells", command.view.cells),
        std::pair("--hierarchy", command.view.hierarchy)})
    if (given) throw UsageError(std::string(name) + ": not for " + kind + ", such as " + command.map);
}

/// Sets the default scale for the errors of coarse cells. Throws UsageError if the given scale has none.
void setErrorScale(const ViewCommand& command, const GaussianMap<3>& map, ViewOptions& view) {
  if (view.hierarchy) return;  // the scale that has no value is grey
  const int coarsest = map.scales() - 1;
  int& scale = *view.scale;
  if (view.colour == ColourBy::Contribution) {
    if (!command.scale) scale = std::min(scale, coarsest - 1);
    if (scale < 0 || scale == coarsest)
      throw UsageError("--color contribution: no scale is coarser than scale " + std::to_string(coarsest) +
                       "; use a finer --scale");
  }
  if (view.colour == ColourBy::CellError) {
    if (!command.scale) scale = coarsest;
    if (scale == 0) throw UsageError("--color cell-error: no scale is finer than scale 0; use a coarser --scale");
  }
}

/// Sets the scale that is shown, which depends on the map.
void setScale(const ViewCommand& command, const GaussianMap<3>& map, ViewOptions& view) {
  if (command.leaves && command.scale) throw UsageError("--leaves and --scale: only one of them may be given");
  if (command.scale) checkScale("--scale", *command.scale, map.scales());
  if (view.colour == ColourBy::CellError && command.leaves)
    throw UsageError("--color cell-error: leaves have no finer cells; use --scale instead of --leaves");
  if (command.leaves) return;
  view.scale = command.scale.value_or(scaleToShow(map));
  setErrorScale(command, map, view);
  if (view.colour == ColourBy::Error && *view.scale == 0 && command.cloud.paths.empty() && !view.hierarchy)
    throw UsageError(
        "--color error: no scale is finer than scale 0; give a CLOUD to compare with or a coarser --scale");
}

void run(ViewCommand command) {
  const auto [width, height] = sizeOf(command);
  ViewOptions view = command.view;
  view.up = kUpAxes.at(command.up);
  const double zoom = view.view.zoom;
  view.view = viewPoint(command, view.up);
  view.view.zoom = zoom;
  view.view.span = command.span;
  if (!command.at.empty()) view.view.middle = Vector<3>(command.at[0], command.at[1], command.at[2]);
  if (!command.colour.empty())
    view.colour = kColours.at(command.colour);
  else if (view.hierarchy && isPlanar(command.map))
    view.colour = ColourBy::Scale;  // all heights are equal
  if (!command.png.path.empty()) {
    requireExtension(command.png.path, ".png");
    checkOutput(command.png, {command.map});
  }
  ViewScene scene;
  scene.name = std::filesystem::path(command.map).filename().string();
  if (isMesh(command.map)) {
    checkWithoutGaussians(command, "meshes");
    scene.map = readPly(command.map);
  } else if (std::filesystem::exists(command.map) && !isGmap(command.map) && isSegmentPcd(command.map)) {
    checkWithoutGaussians(command, "maps of segments");
    scene.map = loadSegmentsPcd(command.map);
  } else {
    GaussianMap<3> map = loadInSpace(command.map);
    if (map.empty()) throw std::runtime_error(command.map + ": the map is empty, so there is nothing to show");
    setScale(command, map, view);
    scene.map = std::move(map);
  }
  if (!command.mesh.empty()) scene.mesh = readPly(command.mesh);
  if (!command.cloud.paths.empty()) scene.cloud = readPoints(command.cloud, 0);
  Viewer viewer(std::move(scene), view);
  if (command.png.path.empty()) return viewer.show(width, height);
  viewer.savePng(command.png.path, width, height);
  std::cout << command.png.path << ": " << width << " x " << height << ", "
            << humanBytes(std::filesystem::file_size(command.png.path)) << '\n';
}

}  // namespace
}  // namespace gaussmap::app

int main(int argc, char** argv) {
  using namespace gaussmap::app;
  handleSignals("gaussmap");
  CLI::App app("", "gaussmap view");
  app.set_help_all_flag("--help-all", kViewHelpAll);
  ViewCommand options;
  addViewOptions(app, options);
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
