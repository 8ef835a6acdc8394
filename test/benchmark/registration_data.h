// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"

namespace gaussmap::benchmark {

using Points = std::vector<Eigen::Vector3d>;

/// Two scans, and the pose of the second one in the frame of the first.
struct ScanPair {
  std::string name;
  Points target, source;  ///< [m], sensor frame
  Pose reference;
};

/// Returns at most `most` pairs of scans of the simulated street. The scans of a pair are `step` scans apart. The truth
/// is exact.
std::vector<ScanPair> streetPairs(std::size_t step, std::size_t most);
/// Returns the same for the PCD files of a directory. The reference poses come from their VIEWPOINTs. The result is
/// empty if the directory does not exist.
std::vector<ScanPair> filePairs(const std::filesystem::path& directory, std::size_t step, std::size_t most);

/// The distance of a start pose from the reference, in any direction.
struct Offset {
  double translation, degrees;  ///< exact values, or maxima of uniform values
  bool at_most;
};
Pose startFrom(const Pose& reference, const Offset& offset, std::uint64_t seed);

/// The difference between a pose and the reference.
struct PoseError {
  double metres, degrees;
};
PoseError errorOf(const Pose& pose, const Pose& reference);

}  // namespace gaussmap::benchmark
