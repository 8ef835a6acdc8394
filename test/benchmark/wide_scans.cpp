// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_wide_scans DIR POINTS [SCANS]: so many simulated points spread over a square kilometre: 25 blocks of the
// simulated street, 200 m apart, each seen with other noise. Scans in the map frame, block by block.
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "gaussmap/core/random.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "street_scene.h"

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: gaussmap_wide_scans DIR POINTS [SCANS]\n";
    return 2;
  }
  constexpr std::size_t kBlocks = 25;
  constexpr double kSide = 200.0, kJitter = 0.02;  // [m]
  const std::size_t points = std::strtoull(argv[2], nullptr, 10),
                    scans = argc == 4 ? std::strtoull(argv[3], nullptr, 10) : 100;
  if (points < scans || scans == 0) {
    std::cerr << "gaussmap_wide_scans: more scans than points\n";
    return 2;
  }
  const auto street = gaussmap::benchmark_input::streetPoints((points + kBlocks - 1) / kBlocks);
  std::filesystem::create_directories(argv[1]);
  std::vector<gaussmap::Vector<3>> scan;
  for (std::size_t i = 0, written = 0; i < points; ++i) {
    const std::size_t block = i / street.size();
    gaussmap::Random random = gaussmap::Random::forPart(1, i);
    gaussmap::Vector<3> point = street[i % street.size()];
    for (int axis = 0; axis < 3; ++axis) point(axis) += kJitter * (random.uniform() - 0.5);
    point.x() += kSide * static_cast<double>(block % 5);
    point.y() += kSide * static_cast<double>(block / 5);
    scan.push_back(point);
    if (i + 1 < (written + 1) * points / scans) continue;
    const std::string number = std::to_string(1000 + written++);
    gaussmap::writePcd(std::filesystem::path(argv[1]) / ("scan" + number + ".pcd"), scan);
    scan.clear();
  }
}
