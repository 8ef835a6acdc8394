// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_large_scan OUT.pcd POINTS [FIRST_SCAN]: one big binary cloud of the simulated street, for timing whole
// commands. From scan 80 on, the same places are seen again with other noise.
#include <cstdlib>
#include <iostream>

#include "gaussmap/io/pcd_writer.h"
#include "street_scene.h"

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: gaussmap_large_scan OUT.pcd POINTS [FIRST_SCAN]\n";
    return 2;
  }
  const std::uint64_t first_scan = argc == 4 ? std::strtoull(argv[3], nullptr, 10) : 0;
  gaussmap::writePcd(argv[1], gaussmap::benchmark_input::streetPoints(std::strtoull(argv[2], nullptr, 10), first_scan));
}
