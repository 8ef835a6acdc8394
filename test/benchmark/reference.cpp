// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark reference MAP SCANS [map]: compares the finest scale of a map with its definition, in long double:
// cell = floor(p / side), mean and covariance of the points in it. The map's own code only reads files, and finds the
// cells of points on a border. Fails if a cell, a count, a mean (1e-5 sides) or a covariance (1e-5 sides^2) differs.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

void compareWithReference(const std::string& map_file, const std::string& folder, ScanFrame frame) {
  const GaussianMapOctree map = load(map_file);
  std::vector<FileScan> scans;
  for (const auto& path : listScans({folder})) scans.push_back({path, normalised(PcdReader(path).header().viewpoint)});
  AccumulateOptions options;

  // Points within half a lattice step of a border can be on either side of it. For these points the map decides.
  const long double side = static_cast<long double>(map.options().resolution), half_step = 0x1.0p-17L;
  std::map<CellKey<3>, std::vector<Vector<3>>> cells;
  for (const Vector<3>& point : readPoints(FileScans(scans, frame), options)) {
    CellKey<3> key;
    for (int axis = 0; axis < 3; ++axis) {
      const long double exact = static_cast<long double>(point(axis)) / side;
      const long double nearest = std::round(exact);
      const bool on_border = std::fabs(exact - nearest) <= half_step * 1.01L;
      key[static_cast<std::size_t>(axis)] = on_border ? map.grid().keyOf(point)[static_cast<std::size_t>(axis)]
                                                      : static_cast<std::int32_t>(std::floor(exact));
    }
    cells[key].push_back(point);
  }

  long double mean_error = 0.0L, cov_error = 0.0L;
  bool same = cells.size() == map.cellCount(0);
  for (const auto& entry : cells) {
    const CellKey<3>& key = entry.first;
    const std::vector<Vector<3>>& points = entry.second;
    const auto cell = map.find(key, 0);
    if (!cell || map.scale(0).moments[*cell].count != static_cast<std::int64_t>(points.size())) {
      same = false;
      continue;
    }
    const auto n = static_cast<long double>(points.size());
    long double mean[3] = {};
    const auto offset = [&](const Vector<3>& point, int axis) {
      return static_cast<long double>(point(axis)) / side - static_cast<long double>(key[std::size_t(axis)]) - 0.5L;
    };
    for (const Vector<3>& point : points)
      for (int axis = 0; axis < 3; ++axis) mean[axis] += offset(point, axis) / n;
    const CellMoments<3>& moments = map.scale(0).moments[*cell];
    for (int row = 0; row < 3; ++row) {
      mean_error = std::max(mean_error, std::fabs(mean[row] - static_cast<long double>(moments.mean(1.0)(row))));
      for (int column = 0; column < 3; ++column) {
        long double product = 0.0L;
        for (const Vector<3>& point : points)
          product += (offset(point, row) - mean[row]) * (offset(point, column) - mean[column]) / n;
        cov_error =
            std::max(cov_error, std::fabs(product - static_cast<long double>(moments.covariance(1.0)(row, column))));
      }
    }
  }
  same = same && mean_error <= 1e-5L && cov_error <= 1e-5L;
  std::printf("%s, %zu cells, mean %.1Le, covariance %.1Le\n", same ? "equal" : "DIFFERENT", cells.size(), mean_error,
              cov_error);
  if (!same) throw std::runtime_error(map_file + ": differs from the reference");
}

}  // namespace

void addReference(CLI::App& app) {
  struct Given {
    std::string map, scans, frame;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("reference", "the finest scale of a map against its definition");
  command.add_option("map", given->map, "map file")->required();
  command.add_option("scans", given->scans, "directory or PCD file that it was built from")->required();
  command.add_option("frame", given->frame, "map: the scans are in the map frame")->check(CLI::IsMember({"map"}));
  command.callback([given] {
    compareWithReference(given->map, given->scans, given->frame.empty() ? ScanFrame::Sensor : ScanFrame::Map);
  });
}

}  // namespace gaussmap::benchmark
