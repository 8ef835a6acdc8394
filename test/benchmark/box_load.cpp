// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark box-load MAP [SIDE]: measures the seconds to load a whole map, and boxes of SIDE metres all over
// it. Each load uses a new MapReader, so only the pages of the file are cached.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "clock.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/gmap/map_reader.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

void loadBoxes(const std::string& path, double side) {
  double start = wallSeconds();
  const GaussianMap<3> whole = load(path);
  const double all = wallSeconds() - start;
  Random random(1);
  std::vector<double> seconds;
  std::size_t cells = 0;
  while (seconds.size() < 25 && !whole.empty()) {  // around random cells
    const std::size_t index = random.below(whole.cellCount(0));
    const Vector<3> centre = whole.grid().centre(whole.scale(0).keys[index], 0);
    const Vector<3> half = Vector<3>::Constant(0.5 * side);
    start = wallSeconds();
    MapReader<3> reader(path);
    const GaussianMap<3> part = reader.load({centre - half, centre + half});
    seconds.push_back(wallSeconds() - start);
    cells += part.cellCount(0);
  }
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds.at(seconds.size() / 2);
  std::printf(
      "whole map: %zu finest cells, %.3f s; box of %g m: %zu cells on average, median %.4f s, slowest %.4f s, "
      "1/%.0f of the whole (slowest 1/%.0f)\n",
      whole.cellCount(0), all, side, cells / seconds.size(), median, seconds.back(), all / median,
      all / seconds.back());
}

}  // namespace

void addBoxLoad(CLI::App& app) {
  struct Given {
    std::string map;
    double side = 50.0;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("box-load", "seconds to load a whole map, and boxes of it");
  command.add_option("map", given->map, "map file")->required();
  command.add_option("side", given->side, "of the boxes [m]")->capture_default_str();
  command.callback([given] { loadBoxes(given->map, given->side); });
}

}  // namespace gaussmap::benchmark
