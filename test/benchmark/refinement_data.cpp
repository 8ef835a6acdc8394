// SPDX-License-Identifier: BSD-3-Clause
#include "refinement_data.h"

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "points/nearest_distances.h"

namespace gaussmap::refinement {
using namespace detail;

namespace {

constexpr double kObserved = 0.5;  // a surface counts as observed up to this distance from a ray's end [m]

/// Returns points of the surface near the ends of rays. The ends themselves are no reference: far from the sensor they
/// are metres apart, so a map that fills the surface between them correctly would seem wrong.
std::vector<Vector<3>> observedSurface(const TriangleMesh& mesh, const std::vector<Vector<3>>& hits, double spacing) {
  const auto count = static_cast<std::size_t>(surfaceArea(mesh) / (spacing * spacing));
  const std::vector<Vector<3>> all = sampleSurface(mesh, count);
  const std::vector<double> distances = nearestDistances(all, hits);
  std::vector<Vector<3>> observed;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (distances[i] <= kObserved) observed.push_back(all[i]);
  return observed;
}

DataSet street(const std::string& name, double spacing, const std::function<Simulation()>& make) {
  const auto load = [make, spacing](std::uint64_t seed) {
    const Simulation simulation = make();
    LoadedData data = simulatedDrive(simulation, seed);
    data.truth = observedSurface(data.mesh, data.hits, spacing);
    return data;
  };
  return {name, "points on the observed surface", {0.1, 10, 3}, {3.4, 4.0}, true, load};
}

DataSet scan(const std::string& name, const std::filesystem::path& path, const MapOptions& options,
             double min_range = 0.0, double max_range = AccumulateOptions().max_range) {
  const auto load = [=](std::uint64_t) {
    AccumulateOptions reading;
    reading.max_range = max_range;
    const Pose pose = normalised(PcdReader(path).header().viewpoint);
    LoadedData data;
    for (const Vector<3>& point : readPoints(FileScans({{path, pose}}), reading))
      if ((point - pose.translation).norm() >= min_range) data.points.push_back(point);
    data.truth = data.points;
    return data;
  };
  return {name, "the points themselves", options, {4.0}, false, load};
}

}  // namespace

LoadedData simulatedDrive(const Simulation& simulation, std::uint64_t seed) {
  LoadedData data;
  data.mesh = simulation.world.mesh();
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const SimulatedScan scan = simulateScan(simulation, i, seed);
    for (const Vector<3>& point : scan.points) data.points.push_back(scan.pose * point);
    data.hits.insert(data.hits.end(), scan.truth.begin(), scan.truth.end());
  }
  return data;
}

std::vector<DataSet> dataSets(const std::filesystem::path& data, int scans, double spacing) {
  SimulationOptions options;
  options.scans = scans;
  std::vector<DataSet> sets = {
      street("simulated street", spacing, [options] { return makeSimulation(WorldName::Street, options); }),
      street("simulated avenue", spacing, [options] { return makeSimulation(WorldName::Avenue, options); })};
  if (data.empty()) return sets;
  sets.push_back(scan("KITTI, one scan", data / "kitti_6scans/000000.pcd", {0.1, 10, 3}, 2.5, 25.0));
  sets.push_back(scan("RGB-D office", data / "rgbd_office_single/office1.pcd", {0.02, 10, 3}));
  sets.push_back(scan("building 079", data / "octomap_geb079/geb079_occupied_8cm.pcd", {0.24, 4, 3}));
  return sets;
}

}  // namespace gaussmap::refinement
