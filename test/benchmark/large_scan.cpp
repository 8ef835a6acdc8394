// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_large_scan OUT.pcd POINTS: one big binary cloud of the simulated street, for timing whole commands.
#include <cstdlib>
#include <iostream>

#include "gaussmap/io/pcd_writer.h"
#include "street_scene.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: gaussmap_large_scan OUT.pcd POINTS\n";
    return 2;
  }
  gaussmap::writePcd(argv[1], gaussmap::benchmark_input::streetPoints(std::strtoull(argv[2], nullptr, 10)));
}
