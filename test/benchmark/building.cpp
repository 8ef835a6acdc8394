// SPDX-License-Identifier: BSD-3-Clause
#include <octomap/octomap.h>
#include <pcl/filters/voxel_grid_covariance.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/build.h"
#include "measure.h"
#include "parts.h"

namespace gaussmap::benchmark {
namespace {

MomentGrid<3> count(const Cloud& cloud, double side, int threads) {
  return countPoints(side, {cloud[0].data, cloud.size(), sizeof(pcl::PointXYZ) / sizeof(float)}, threads);
}

/// Computes the exact sums only, which a map keeps while it grows.
double sums(const Cloud& cloud, double side, int threads) {
  return static_cast<double>(count(cloud, side, threads).size());
}

/// Computes the sums, the cells in key order, and the Gaussian of every cell with its eigen-decomposition.
/// VoxelGridCovariance computes the eigen-decomposition too.
double gaussians(const Cloud& cloud, double side) {
  const GaussianMapOctree map = build<3>(count(cloud, side, 1), {side, 2, 1, 0.0});
  double flatness = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
    flatness += principalAxes<3>(map.localGaussian(i, 0)).flatness();
  return flatness;
}

/// The simple method: a standard hash map of double sums relative to the centre of the cell.
double unorderedMap(const Cloud& cloud, double side) {
  struct Key {
    int x, y, z;
    bool operator==(const Key& o) const { return x == o.x && y == o.y && z == o.z; }
  };
  struct Hash {
    std::size_t operator()(const Key& k) const {
      return static_cast<std::size_t>(k.x) * 73856093u ^ static_cast<std::size_t>(k.y) * 19349669u ^
             static_cast<std::size_t>(k.z) * 83492791u;
    }
  };
  struct Sums {
    double n = 0.0, sum[3] = {}, product[6] = {};
  };
  const double per_side = 1.0 / side;
  std::unordered_map<Key, Sums, Hash> cells;
  for (const pcl::PointXYZ& p : cloud) {
    const double px = static_cast<double>(p.x), py = static_cast<double>(p.y), pz = static_cast<double>(p.z);
    const Key key{static_cast<int>(std::floor(px * per_side)), static_cast<int>(std::floor(py * per_side)),
                  static_cast<int>(std::floor(pz * per_side))};
    Sums& s = cells[key];
    const double x = px - (key.x + 0.5) * side, y = py - (key.y + 0.5) * side, z = pz - (key.z + 0.5) * side;
    s.n += 1.0;
    s.sum[0] += x, s.sum[1] += y, s.sum[2] += z;
    s.product[0] += x * x, s.product[1] += x * y, s.product[2] += x * z;
    s.product[3] += y * y, s.product[4] += y * z, s.product[5] += z * z;
  }
  return static_cast<double>(cells.size());
}

double voxelGridCovariance(const Cloud::Ptr& cloud, double side) {
  pcl::VoxelGridCovariance<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  const auto leaf = static_cast<float>(side);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.filter(false);
  return static_cast<double>(grid.getLeaves().size());
}

/// Adds the end points only, without rays.
double octomapHits(const Cloud& cloud, double side) {
  octomap::OcTree tree(side);
  for (const pcl::PointXYZ& p : cloud) tree.updateNode(octomap::point3d(p.x, p.y, p.z), true, true);
  tree.updateInnerOccupancy();
  return static_cast<double>(tree.getNumLeafNodes());
}

}  // namespace

void measureBuilding(const Input& input, int runs, Table& table) {
  const Cloud::Ptr& cloud = input.cloud;
  for (const double side : {1.0, 0.2}) {
    const std::vector<Measured> of =
        measureInTurn({[&] { return sums(*cloud, side, 1); }, [&] { return sums(*cloud, side, 2); },
                       [&] { return gaussians(*cloud, side); }, [&] { return voxelGridCovariance(cloud, side); },
                       [&] { return unorderedMap(*cloud, side); }, [&] { return octomapHits(*cloud, side); }},
                      runs);
    const Measured &one = of[0], &two = of[1], &whole = of[2], &voxels = of[3], &plain = of[4], &octomap = of[5];
    char name[96];
    std::snprintf(name, sizeof name, "%s, %.1f M, %g m", input.name.c_str(), static_cast<double>(cloud->size()) / 1e6,
                  side);
    const auto row = [&](const char* part, int threads, const Measured& ours, const char* peer,
                         const Measured& theirs) {
      table.add(Row{part, name, threads, ours.seconds, ours.megabytes, peer, theirs.seconds, theirs.megabytes});
    };
    row("exact sums", 1, one, "pcl::VoxelGridCovariance", voxels);
    row("exact sums", 1, one, "std::unordered_map", plain);
    row("exact sums", 1, one, "OctoMap, hits", octomap);
    row("exact sums", 2, two, "gaussmap, one thread", one);
    row("Gaussians and their axes", 1, whole, "pcl::VoxelGridCovariance", voxels);
    if (one.value < 1e5) continue;  // with few cells, whole memory pages distort the figure
    const auto per_cell = [](const Measured& measured) { return measured.megabytes * 1048576.0 / measured.value; };
    const double held = measureInTurn({[&] { return double(count(*cloud, side, 1).memoryBytes()); }}, 1).front().value;
    table.add(Figure{"memory", name, "exact sums, held", "bytes per cell", held / one.value});
    table.add(Figure{"memory", name, "exact sums, peak of the process", "bytes per cell", per_cell(one)});
    table.add(
        Figure{"memory", name, "pcl::VoxelGridCovariance, peak of the process", "bytes per cell", per_cell(voxels)});
    table.add(Figure{"memory", name, "std::unordered_map, peak of the process", "bytes per cell", per_cell(plain)});
    table.add(Figure{"memory", name, "OctoMap, hits, peak of the process", "bytes per leaf", per_cell(octomap)});
  }
}

void measureCoarsening(const Input& input, int runs, Table& table) {
  const auto scales = [&](int count_of) {
    return [&input, count_of] {
      return static_cast<double>(build<3>(count(*input.cloud, 0.2, 1), {0.2, 5, count_of, 0.0}).cellCount(0));
    };
  };
  // This is a small difference of two large times. With a few runs, the share would come out half or twice its value.
  const std::vector<Measured> of = measureInTurn({scales(1), scales(4)}, std::max(runs, 15));
  table.add(Figure{"coarser scales", input.name + ", 0.2, 1, 5, 25 m", "share of the build", "%",
                   100.0 * (of[1].seconds - of[0].seconds) / of[1].seconds});
}

}  // namespace gaussmap::benchmark
