// SPDX-License-Identifier: BSD-3-Clause
#include "registration_data.h"

#include <Eigen/Geometry>
#include <cmath>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "simulation/simulation.h"

namespace gaussmap::benchmark {
namespace {

const double kDegree = std::acos(-1.0) / 180.0;

Pose relative(const Pose& target, const Pose& source) {
  return {target.rotation.conjugate() * (source.translation - target.translation),
          Eigen::Quaterniond(target.rotation.conjugate()) * Eigen::Quaterniond(source.rotation)};
}

Points returnsOf(const Points& points) {
  Points returns;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) returns.push_back(point);
  return returns;
}

Eigen::Vector3d direction(Random& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

}  // namespace

std::vector<ScanPair> streetPairs(std::size_t step, std::size_t most) {
  const Simulation street = makeSimulation(WorldName::Street);
  std::vector<ScanPair> pairs;
  for (std::size_t i = 0; i + step < street.trajectory.size() && pairs.size() < most; ++i) {
    const SimulatedScan target = simulateScan(street, i), source = simulateScan(street, i + step);
    pairs.push_back({std::to_string(i) + "-" + std::to_string(i + step), returnsOf(target.points),
                     returnsOf(source.points), relative(target.pose, source.pose)});
  }
  return pairs;
}

std::vector<ScanPair> filePairs(const std::filesystem::path& directory, std::size_t step, std::size_t most) {
  if (!std::filesystem::is_directory(directory)) return {};
  const auto files = listScans({directory});
  std::vector<ScanPair> pairs;
  for (std::size_t i = 0; i + step < files.size() && pairs.size() < most; ++i) {
    const auto& a = files[i];
    const auto& b = files[i + step];
    pairs.push_back(
        {a.stem().string() + "-" + b.stem().string(), returnsOf(FileScans({{a, Pose()}}).read(0).points),
         returnsOf(FileScans({{b, Pose()}}).read(0).points),
         relative(normalised(PcdReader(a).header().viewpoint), normalised(PcdReader(b).header().viewpoint))});
  }
  return pairs;
}

Pose startFrom(const Pose& reference, const Offset& offset, std::uint64_t seed) {
  Random random(seed);
  const double part = offset.at_most ? random.uniform() : 1.0, turned = offset.at_most ? random.uniform() : 1.0;
  const Eigen::Vector3d way = direction(random), axis = direction(random);
  return {reference.translation + part * offset.translation * way,
          Eigen::Quaterniond(Eigen::AngleAxisd(turned * offset.degrees * kDegree, axis)) *
              Eigen::Quaterniond(reference.rotation)};
}

PoseError errorOf(const Pose& pose, const Pose& reference) {
  return {(pose.translation - reference.translation).norm(),
          Eigen::Quaterniond(pose.rotation).angularDistance(Eigen::Quaterniond(reference.rotation)) / kDegree};
}

}  // namespace gaussmap::benchmark
