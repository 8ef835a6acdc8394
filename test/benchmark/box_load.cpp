// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_box_load MAP [SIDE]: seconds to load a whole map, and boxes of so many metres all over it, each with a fresh
// MapReader, so that nothing is cached but the pages of the file.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "gaussmap/core/random.h"
#include "gaussmap/io/gmap/map_reader.h"

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run(const char* path, double side) {
  using namespace gaussmap;
  double start = now();
  const GaussianMap<3> whole = loadMap<3>(path);
  const double all = now() - start;
  Random random(1);
  std::vector<double> seconds;
  std::size_t cells = 0;
  while (seconds.size() < 25 && !whole.empty()) {  // around cells drawn by lot
    const std::size_t index = random.below(whole.cellCount(0));
    const Vector<3> centre = whole.grid().centre(whole.scale(0).keys[index], 0);
    const Vector<3> half = Vector<3>::Constant(0.5 * side);
    start = now();
    MapReader<3> reader(path);
    const GaussianMap<3> part = reader.load({centre - half, centre + half});
    seconds.push_back(now() - start);
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

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::cerr << "usage: gaussmap_box_load MAP [SIDE]\n";
    return 2;
  }
  try {
    run(argv[1], argc == 3 ? std::strtod(argv[2], nullptr) : 50.0);
  } catch (const std::exception& error) {
    std::cerr << "gaussmap_box_load: " << error.what() << '\n';
    return 1;
  }
}
