// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark wide-scans DIR POINTS [SCANS]: writes simulated points spread over a square kilometre: 25 blocks
// of the simulated street, 200 m apart, each with other noise. The scans are in the map frame, block by block.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "street_points.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

void writeWideScans(const std::filesystem::path& folder, std::size_t points, std::size_t scans) {
  constexpr std::size_t kBlocks = 25;
  constexpr double kSide = 200.0, kJitter = 0.02;  // [m]
  if (points < scans) throw std::invalid_argument("wide-scans: more scans than points");
  const auto street = streetPoints((points + kBlocks - 1) / kBlocks);
  std::filesystem::create_directories(folder);
  std::vector<Vector<3>> scan;
  for (std::size_t i = 0, written = 0; i < points; ++i) {
    const std::size_t block = i / street.size();
    Random random = Random::forPart(1, i);
    Vector<3> point = street[i % street.size()];
    for (int axis = 0; axis < 3; ++axis) point(axis) += kJitter * (random.uniform() - 0.5);
    point.x() += kSide * static_cast<double>(block % 5);
    point.y() += kSide * static_cast<double>(block / 5);
    scan.push_back(point);
    if (i + 1 < (written + 1) * points / scans) continue;
    const std::string number = std::to_string(1000 + written++);
    writePcd(folder / ("scan" + number + ".pcd"), scan);
    scan.clear();
  }
}

}  // namespace

void addWideScans(CLI::App& app) {
  struct Given {
    std::string folder;
    std::size_t points = 0, scans = 100;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("wide-scans", "write simulated scans of a square kilometre");
  command.add_option("dir", given->folder, "directory to write to")->required();
  command.add_option("points", given->points, "in all scans together")->required()->check(CLI::PositiveNumber);
  command.add_option("scans", given->scans, "number of files")->check(CLI::PositiveNumber)->capture_default_str();
  command.callback([given] { writeWideScans(given->folder, given->points, given->scans); });
}

}  // namespace gaussmap::benchmark
