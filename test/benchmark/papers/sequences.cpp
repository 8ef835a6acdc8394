// SPDX-License-Identifier: BSD-3-Clause
#include "papers/sequences.h"

#include <algorithm>
#include <cmath>

#include "core/in_space.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/map/sampling.h"
#include "points/nearest_distances.h"
#include "segment_data.h"
#include "segments/level_scan.h"
#include "simulation/simulation.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

const MapOptions kPlanarGrid{0.05, 10, 3, 0.0}, kGrid{0.1, 10, 3, 0.0};

template <typename T>
void keepFirst(std::vector<T>& list, std::size_t count) {
  if (count > 0 && list.size() > count) list.resize(count);
}

std::shared_ptr<const MeshDistance> truthOf(const Simulation& simulation) {
  return std::make_shared<const MeshDistance>(simulation.world.mesh());
}

Sequence<3> street(std::size_t scans) {
  SimulationOptions options;
  options.scans = 320;  // as many as the paper needs from 53 to 181 clusters, with 4 clusters every 10 scans
  Simulation simulation = makeSimulation(WorldName::Street, options);
  LidarOptions& lidar = std::get<LidarOptions>(simulation.sensor);
  lidar.rings = 32;
  lidar.columns = 600;
  Sequence<3> sequence{"simulated street", kGrid, {}, truthOf(simulation)};
  if (scans > 0 && scans < simulation.trajectory.size()) simulation.trajectory.resize(scans);
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    SimulatedScan scan = simulateScan(simulation, i);
    sequence.scans.push_back({std::move(scan.points), scan.pose, 0, std::nullopt});
  }
  return sequence;
}

}  // namespace

template <int D>
std::vector<Vector<3>> Sequence<D>::points(std::size_t count) const {
  std::vector<Vector<3>> all;
  for (std::size_t i = 0; i < std::min(count, scans.size()); ++i)
    for (const Eigen::Vector3d& point : scans[i].points) {
      if (!isReturn(point)) continue;
      all.push_back(scans[i].pose * point);
      if (D == 2) all.back().z() = 0.0;
    }
  return all;
}

std::vector<Sequence<2>> planarSequences(const std::filesystem::path& data, std::size_t scans) {
  std::vector<Sequence<2>> sequences;
  std::vector<LaserScan> plan = benchmark::scanPlan(0.01, 0.0, 1);
  keepFirst(plan, scans);
  sequences.push_back({"simulated plan", kPlanarGrid, {}, truthOf(makeSimulation(WorldName::Plan))});
  for (const LaserScan& sweep : plan) sequences.back().scans.push_back(scanOfBeams(sweep));
  if (data.empty()) return sequences;
  std::vector<LaserScan> intel = benchmark::readLogIn(data / "carmen_intel");
  keepFirst(intel, scans);
  sequences.push_back({"Intel lab", kPlanarGrid, {}, nullptr});
  for (const LaserScan& sweep : intel) sequences.back().scans.push_back(scanOfBeams(sweep));
  return sequences;
}

std::vector<Sequence<3>> sequencesInSpace(const std::filesystem::path& data, std::size_t scans) {
  std::vector<Sequence<3>> sequences{street(scans)};
  if (data.empty()) return sequences;
  sequences.push_back({"MulRan", kGrid, {}, nullptr});
  for (const std::filesystem::path& path : listScans({data / "mulran_kaist03_21scans"}))
    sequences.back().scans.push_back(FileScans({{path, normalised(PcdReader(path).header().viewpoint)}}).read(0));
  keepFirst(sequences.back().scans, scans);
  return sequences;
}

template <int D>
SampleDistances distancesOf(const GaussianMap<D>& map, int scale, std::size_t samples, const Sequence<D>& sequence,
                            std::size_t scans) {
  SampleOptions sampling;
  sampling.samples = samples;
  sampling.at_least = 1;
  sampling.bounds = SampleBounds::Cell;
  sampling.threads = 1;
  const MapSamples<D> drawn = sampleMap<D>(map, scale, sampling);
  const std::vector<Vector<3>> points = inSpace(drawn.points);
  const std::vector<double> distances =
      sequence.mesh ? meshDistances(points, *sequence.mesh, 1) : nearestDistances(points, sequence.points(scans), 1);
  SampleDistances result{summarise(distances), 0.0};
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (drawn.mahalanobis[i] <= 2.0) result.within_two_sigma = std::max(result.within_two_sigma, distances[i]);
  return result;
}

template <int D>
double volumeOf(const GaussianMap<D>& map, int scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) sum += std::sqrt(map.gaussian(i, scale).cov.determinant());
  return sum;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                        \
  template struct Sequence<D>;                                                                                         \
  template SampleDistances distancesOf<D>(const GaussianMap<D>&, int, std::size_t, const Sequence<(D)>&, std::size_t); \
  template double volumeOf<D>(const GaussianMap<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::papers
