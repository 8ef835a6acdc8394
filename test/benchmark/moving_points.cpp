// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark moving-points DIR...: compares how gaussmap clean, pcd2map --online and OctoMap remove moving
// objects from the same scans, with one thread, at 0.2 and 0.1 m (--cells: at others). OctoMap uses insertPointCloud
// with rays; points of free cells are removed. Prints SA, DA and AA in percent against the field `label` (without this
// field all points count as static), and the seconds per scan without reading. With --free-points: how freePoints(),
// and so DynamicPointsFilter, removes them by a map of all scans, and by a map of the scans before each scan.
#include <octomap/octomap.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clock.h"
#include "evaluation/removal_score.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

struct Sequence {
  std::vector<FileScan> sources;
  std::vector<Scan> scans;
  std::vector<std::vector<double>> labels;  // 0 = static

  explicit Sequence(const std::string& folder) {
    for (const auto& path : listScans({folder})) {
      const PcdReader reader(path);
      sources.push_back({path, normalised(reader.header().viewpoint)});
      scans.push_back(FileScans({sources.back()}).read(0));
      labels.emplace_back(scans.back().points.size(), 0.0);
      if (reader.header().find("label")) labels.back() = reader.column("label");
    }
  }

  Eigen::Vector3d inMap(std::size_t scan, std::size_t point) const {
    return scans[scan].pose.rotation * scans[scan].points[point] + scans[scan].pose.translation;
  }

  RemovalScore score(const std::function<bool(std::size_t, std::size_t)>& isRemoved) const {
    RemovalScore result;
    for (std::size_t s = 0; s < scans.size(); ++s)
      for (std::size_t p = 0; p < labels[s].size(); ++p)
        if (isReturn(scans[s].points[p])) result.add(labels[s][p] != 0.0, isRemoved(s, p));
    return result;
  }
};

void print(const char* method, const RemovalScore& score, double seconds, std::size_t scans) {
  std::printf("  %-22s SA %7.3f  DA %6.2f  AA %6.2f  %8.4f s per scan\n", method, 100.0 * score.staticAccuracy(),
              score.moving ? 100.0 * score.dynamicAccuracy() : 0.0,
              score.moving ? 100.0 * score.associatedAccuracy() : 0.0, seconds / double(scans));
  std::fflush(stdout);
}

/// Which lengths the rules for moving objects have at cells below 15 mm.
enum class Lengths {
  OfTheCells,  // the defaults, which shrink with the cells
  Fixed        // those of cells of 15 mm and more
};

template <typename Options>
void setLengths(Lengths lengths, VisibilityOptions& visibility, Options& cells, SharedCellOptions& shared) {
  if (lengths == Lengths::OfTheCells) return;
  visibility.tolerance = 0.3;
  visibility.clearance = 0.35;
  visibility.spacing = 0.03;
  cells.link = 0.2;
  cells.reach = 0.5;
  shared = {0.6, 0.04, 0.01, 0.05};
}

void clean(const Sequence& sequence, double resolution, Lengths lengths) {
  MovingPointOptions options;
  options.resolution = resolution;
  setLengths(lengths, options.evidence.visibility, options.cells, options.shared);
  options.evidence.threads = 1;
  const double start = wallSeconds();
  const MovingPoints moving(std::make_shared<const FileScans>(sequence.sources), options);
  const double seconds = wallSeconds() - start;
  std::vector<std::vector<bool>> flags;
  for (std::size_t s = 0; s < sequence.scans.size(); ++s) flags.push_back(moving.inScan(s));
  print("clean (with reading)", sequence.score([&](auto s, auto p) { return flags[s][p]; }), seconds,
        sequence.scans.size());
}

double online(const Sequence& sequence, double resolution, Lengths lengths) {
  OnlineOptions options;
  options.map = {resolution, 5, 3, 0.0};  // 0.2, 1, 5 m
  setLengths(lengths, options.visibility, options, options.shared);
  options.threads = 1;
  std::set<CellKey<3>> touched;  // cells from which a cluster was deleted
  OnlineMapper<3> mapper(options, [&](const RemovedCluster<3>& cluster) {
    if (cluster.scale == 0) touched.insert(cluster.key);
  });
  OnlineStatistics sum;
  const double start = wallSeconds();
  for (const Scan& scan : sequence.scans) {
    const OnlineStatistics one = mapper.add(scan);
    sum.update_time += one.update_time;
    sum.image_time += one.image_time;
    sum.look_back_time += one.look_back_time;
    sum.occupancy_time += one.occupancy_time;
    sum.forget_time += one.forget_time;
    sum.refine_time += one.refine_time;
  }
  const double seconds = wallSeconds() - start;
  const GaussianMap<3> map = mapper.map();
  print("pcd2map --online", sequence.score([&](auto s, auto p) {
    // A point counts as removed if its cell was removed. If only a part of the cell was deleted, a point counts as
    // removed if it lies beyond three standard deviations of the rest.
    const Eigen::Vector3d point = sequence.inMap(s, p);
    const auto cell = map.find(map.grid().keyOf(point), 0);
    return !cell ||
           (touched.count(map.scale(0).keys[*cell]) > 0 && mahalanobisSquared<3>(point, map.gaussian(*cell, 0)) > 9.0);
  }),
        seconds, sequence.scans.size());
  std::printf(
      "  %22s update %.0f %%, range image %.0f %%, look back %.0f %%, occupancy %.0f %%, forget %.0f %%, refine %.0f "
      "%%\n",
      "", 100.0 * sum.update_time / seconds, 100.0 * sum.image_time / seconds, 100.0 * sum.look_back_time / seconds,
      100.0 * sum.occupancy_time / seconds, 100.0 * sum.forget_time / seconds, 100.0 * sum.refine_time / seconds);
  return seconds;
}

double octomapWithRays(const Sequence& sequence, double resolution) {
  octomap::OcTree tree(resolution);
  double seconds = 0.0;
  for (std::size_t s = 0; s < sequence.scans.size(); ++s) {
    octomap::Pointcloud cloud;
    for (std::size_t p = 0; p < sequence.scans[s].points.size(); ++p) {
      if (!isReturn(sequence.scans[s].points[p])) continue;
      const Eigen::Vector3f point = sequence.inMap(s, p).cast<float>();
      cloud.push_back(point.x(), point.y(), point.z());
    }
    const Eigen::Vector3f origin = sequence.scans[s].pose.translation.cast<float>();
    const double start = wallSeconds();
    tree.insertPointCloud(cloud, octomap::point3d(origin.x(), origin.y(), origin.z()));
    seconds += wallSeconds() - start;
  }
  print("OctoMap with rays", sequence.score([&](auto s, auto p) {
    const Eigen::Vector3f point = sequence.inMap(s, p).template cast<float>();
    const octomap::OcTreeNode* const node = tree.search(point.x(), point.y(), point.z());
    return node && !tree.isNodeOccupied(node);
  }),
        seconds, sequence.scans.size());
  return seconds;
}

/// Removes points from every scan number `every` - 1, 2 `every` - 1 and so on.
void freeSpace(const Sequence& sequence, double resolution, std::size_t every) {
  OnlineOptions options;
  options.map.resolution = resolution;
  options.threads = 1;
  const std::pair<UnknownSpace, const char*> modes[] = {
      {UnknownSpace::Automatic, "Automatic"}, {UnknownSpace::Keep, "Keep"}, {UnknownSpace::Remove, "Remove"}};
  for (const bool whole : {true, false}) {
    RemovalScore scores[3];
    double seconds[3] = {};
    std::size_t scans = 0;
    const auto test = [&](const GaussianMapOctree& map, std::size_t s) {
      ++scans;
      std::vector<Eigen::Vector3d> points;
      std::vector<bool> moves;
      for (std::size_t p = 0; p < sequence.labels[s].size(); ++p) {
        if (!isReturn(sequence.scans[s].points[p])) continue;
        points.push_back(sequence.inMap(s, p));
        moves.push_back(sequence.labels[s][p] != 0.0);
      }
      for (int mode = 0; mode < 3; ++mode) {
        FreePointOptions free;
        free.unknown = modes[mode].first;
        free.threads = 1;
        const double start = wallSeconds();
        const std::vector<bool> removed = freePoints(map, points, sequence.scans[s].pose.translation, free);
        seconds[mode] += wallSeconds() - start;
        for (std::size_t p = 0; p < points.size(); ++p) scores[mode].add(moves[p], removed[p]);
      }
    };
    OnlineMapper<3> mapper(options);
    for (std::size_t s = 0; s < sequence.scans.size(); ++s) {
      if (!whole && s > 0 && (s + 1) % every == 0) test(mapper.map(), s);
      mapper.add(sequence.scans[s]);
    }
    if (whole) {
      const GaussianMapOctree map = mapper.map();
      for (std::size_t s = every - 1; s < sequence.scans.size(); s += every) test(map, s);
    }
    std::printf(" map of %s scans\n", whole ? "all" : "the earlier");
    for (int mode = 0; mode < 3; ++mode) print(modes[mode].second, scores[mode], seconds[mode], scans);
  }
}

}  // namespace

void addMovingPoints(CLI::App& app) {
  const auto folders = std::make_shared<std::vector<std::string>>();
  CLI::App& command = *app.add_subcommand("moving-points", "moving objects: clean, pcd2map --online and OctoMap");
  command.add_option("dir", *folders, "directories of PCD scans")->required();
  const auto free_points = std::make_shared<bool>(false);
  const auto every = std::make_shared<std::size_t>(1);
  command.add_flag("--free-points", *free_points, "freePoints() instead");
  command.add_option("--every", *every, "--free-points: test only every this many scans")->check(CLI::PositiveNumber);
  const auto cells = std::make_shared<std::vector<double>>(std::vector<double>{0.2, 0.1});
  command.add_option("--cells", *cells, "sides of the finest cells [m]")->check(CLI::PositiveNumber);
  const auto fixed = std::make_shared<bool>(false), ours = std::make_shared<bool>(false);
  command.add_flag("--fixed-lengths", *fixed, "cells below 15 mm: the lengths of larger cells");
  command.add_flag("--without-octomap", *ours, "do not run OctoMap");
  command.callback([folders, free_points, every, cells, fixed, ours] {
    const Lengths lengths = *fixed ? Lengths::Fixed : Lengths::OfTheCells;
    for (const std::string& folder : *folders) {
      const Sequence sequence(folder);
      for (const double resolution : *cells) {
        std::printf("%s, %zu scans, %g m\n", folder.c_str(), sequence.scans.size(), resolution);
        if (*free_points) {
          freeSpace(sequence, resolution, *every);
          continue;
        }
        clean(sequence, resolution, lengths);
        const double seconds = online(sequence, resolution, lengths);
        if (*ours) continue;
        const double theirs = octomapWithRays(sequence, resolution);
        std::printf("  OctoMap's time / pcd2map --online: %.1f\n", theirs / seconds);
      }
    }
  });
}

}  // namespace gaussmap::benchmark
