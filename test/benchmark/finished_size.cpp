// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark finished-size DIR (from gaussmap simulate street): compares the size of a final map with OctoMap's
// .bt file of the same mean error. The map has the 1 m cells of a simulated street, with twice as many Gaussians as
// cells. The octree has the resolution at which its occupied voxels lie equally far from the true surface. Samples are
// spread evenly over the volume of ellipsoids (inside their cells) and of voxels. Distances are to the mesh. OctoMap
// takes the scans with their rays, as usual, and also the end points alone, which give no free space.
#include <octomap/octomap.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/sensor/projection.h"
#include "io/files/temporary_directory.h"
#include "mesh/mesh_distance.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSamples = 100000;

double meanError(const std::vector<Vector<3>>& samples, const MeshDistance& truth) {
  const std::vector<double> distances = meshDistances(samples, truth);
  return std::accumulate(distances.begin(), distances.end(), 0.0) / static_cast<double>(distances.size());
}

/// An octree of the scans.
class Octree {
 public:
  Octree(const std::vector<Scan>& scans, double resolution, bool rays) : tree_(resolution) {
    for (const Scan& scan : scans) {
      octomap::Pointcloud cloud;
      for (const Eigen::Vector3d& point : scan.points) {
        if (!isReturn(point)) continue;
        const Eigen::Vector3f p = (scan.pose * point).cast<float>();
        cloud.push_back(p.x(), p.y(), p.z());
        if (!rays) tree_.updateNode(octomap::point3d(p.x(), p.y(), p.z()), true, true);
      }
      const Eigen::Vector3f origin = scan.pose.translation.cast<float>();
      if (rays) tree_.insertPointCloud(cloud, octomap::point3d(origin.x(), origin.y(), origin.z()), -1.0, true, true);
    }
    tree_.updateInnerOccupancy();
  }

  /// Returns points spread evenly over the volume of the occupied voxels.
  std::vector<Vector<3>> samples() const {
    double volume = 0.0;
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf)
      if (tree_.isNodeOccupied(*leaf)) volume += std::pow(leaf.getSize(), 3);
    Random random(1);
    std::vector<Vector<3>> points;
    double owed = 0.0;
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) {
      if (!tree_.isNodeOccupied(*leaf)) continue;
      const double side = leaf.getSize();
      for (owed += std::pow(side, 3) / volume * static_cast<double>(kSamples); owed >= 1.0; owed -= 1.0)
        points.emplace_back(leaf.getX() + side * (random.uniform() - 0.5),
                            leaf.getY() + side * (random.uniform() - 0.5),
                            leaf.getZ() + side * (random.uniform() - 0.5));
    }
    return points;
  }

  /// Writes the .bt file and returns its size [bytes].
  std::uintmax_t bytes(const fs::path& folder) {
    const fs::path path = folder / "tree.bt";
    tree_.writeBinary(path.string());  // maximum likelihood, pruned
    return fs::file_size(path);
  }

 private:
  octomap::OcTree tree_;
};

/// Searches for the resolution of equal error, starting from `resolution`. Prints the result and returns it.
double compare(const std::vector<Scan>& scans, const MeshDistance& truth, bool rays, double resolution, double error,
               double bytes, const fs::path& folder) {
  for (int step = 0;; ++step) {
    Octree tree(scans, resolution, rays);
    const double reached = meanError(tree.samples(), truth);
    if (step < 4 && std::abs(reached / error - 1.0) > 0.02) {
      resolution *= error / reached;
      continue;
    }
    const auto octree = static_cast<double>(tree.bytes(folder));
    std::printf("OctoMap %s, %.3f m: mean error %.4f m, .bt %.0f bytes, %.1f times the map's\n",
                rays ? "with rays" : "end points only", resolution, reached, octree, octree / bytes);
    std::fflush(stdout);
    return resolution;
  }
}

void compareSizes(const fs::path& folder) {
  std::vector<FileScan> sources;
  std::vector<Scan> scans;
  for (const fs::path& path : listScans({folder / "scans"})) {
    sources.push_back({path, normalised(PcdReader(path).header().viewpoint)});
    scans.push_back(FileScans({sources.back()}).read(0));
  }
  const MeshDistance truth(readPly(folder / "truth.ply"));
  const GaussianMap<3> map =
      refine<3>(build<3>(accumulateScans(FileScans(sources), {}).moments, MapOptions()), PerCell{2.0}).map;

  const test::TemporaryDirectory work;
  const fs::path path = work.path() / "map.gmap";
  save(path, finish<3>(map, 1), {}, {true, 15, 0, Precision::Finished});
  const GaussianMap<3> finished = load(path);
  SampleOptions sampling;
  sampling.samples = kSamples;
  sampling.at_least = 1;
  const double error = meanError(sampleMap<3>(finished, 1, sampling).points, truth);
  const MapFileSize size = mapFileSize(path);
  std::printf(
      "%zu scans; the %g m cells, finished: %zu Gaussians, mean error %.4f m (%.4f m before), file %ju bytes, "
      "its tiles of this scale %ju\n",
      scans.size(), map.grid().side(1), finished.gaussianCount(1), error,
      meanError(sampleMap<3>(finish<3>(map, 0), 1, sampling).points, truth), size.file, size.scale_tiles.at(1));
  std::fflush(stdout);
  double resolution = 4.0 * error;       // a voxel crossed by a surface is about a quarter of its side away
  for (const bool rays : {false, true})  // end points first: faster, and nearly the same resolution
    resolution = compare(scans, truth, rays, resolution, error, static_cast<double>(size.file), work.path());
}

}  // namespace

void addFinishedSize(CLI::App& app) {
  const auto folder = std::make_shared<std::string>();
  CLI::App& command =
      *app.add_subcommand("finished-size", "a finished map beside OctoMap's .bt of the same mean error");
  command.add_option("dir", *folder, "of gaussmap simulate street")->required()->check(CLI::ExistingDirectory);
  command.callback([folder] { compareSizes(*folder); });
}

}  // namespace gaussmap::benchmark
