// SPDX-License-Identifier: BSD-3-Clause
#include <octomap/octomap.h>

#include "gaussmap/core/scans.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "measure.h"
#include "parts.h"
#include "simulation/simulation.h"

namespace gaussmap::benchmark {
namespace {

std::vector<Scan> simulatedScans() {
  SimulationOptions street;
  street.scans = 6;
  Simulation simulation = makeSimulation(WorldName::Street, street);
  std::get<LidarOptions>(simulation.sensor).threads = 1;
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const SimulatedScan made = simulateScan(simulation, i, 1);
    scans.push_back({made.points, made.pose, 0});
  }
  return scans;
}

std::vector<Scan> scansIn(const std::filesystem::path& folder) {
  std::vector<Scan> scans;
  for (const auto& path : listScans({folder}))
    scans.push_back(FileScans({{path, normalised(PcdReader(path).header().viewpoint)}}).read(0));
  return scans;
}

/// Runs learning, occupancy, forgetting and refinement: everything that pcd2map --online does, except reading.
double ours(const std::vector<Scan>& scans, double resolution, int threads) {
  OnlineOptions options;
  options.map = {resolution, 5, 3, 0.0};
  options.threads = threads;
  OnlineMapper<3> mapper(options);
  for (const Scan& scan : scans) mapper.add(scan);
  return static_cast<double>(mapper.map().cellCount(0));
}

double octomapWithRays(const std::vector<Scan>& scans, double resolution) {
  octomap::OcTree tree(resolution);
  for (const Scan& scan : scans) {
    octomap::Pointcloud cloud;
    for (const Eigen::Vector3d& point : scan.points) {
      if (!isReturn(point)) continue;
      const Eigen::Vector3f in_map = (scan.pose * point).cast<float>();
      cloud.push_back(in_map.x(), in_map.y(), in_map.z());
    }
    const Eigen::Vector3f origin = scan.pose.translation.cast<float>();
    tree.insertPointCloud(cloud, octomap::point3d(origin.x(), origin.y(), origin.z()));
  }
  return static_cast<double>(tree.getNumLeafNodes());
}

void measureScans(const std::string& name, const std::vector<Scan>& scans, Table& table) {
  for (const double resolution : {0.2, 0.1}) {
    const auto mapper = [&](int threads) { return [&, threads] { return ours(scans, resolution, threads); }; };
    const std::vector<Measured> of =
        measureInTurn({mapper(1), mapper(2), [&] { return octomapWithRays(scans, resolution); }}, 1);
    const std::string input =
        name + ", " + std::to_string(scans.size()) + " scans, " + (resolution == 0.2 ? "0.2 m" : "0.1 m");
    for (int threads = 1; threads <= 2; ++threads) {
      const Measured& own = of[static_cast<std::size_t>(threads) - 1];
      table.add(Row{"on-line mapping", input, threads, own.seconds, own.megabytes, "OctoMap with rays", of[2].seconds,
                    of[2].megabytes});
    }
  }
}

}  // namespace

void measureOnline(const Options& options, Table& table) {
  measureScans("simulated street", simulatedScans(), table);
  if (!options.data.empty())
    measureScans("kitti_6scans", scansIn(std::filesystem::path(options.data) / "kitti_6scans"), table);
}

}  // namespace gaussmap::benchmark
