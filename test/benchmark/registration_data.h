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

/// Two scans and where the second stood in the frame of the first.
struct ScanPair {
  std::string name;
  Points target, source;  ///< [m], sensor frame
  Pose reference;
};

/// Scans `step` apart, at most `most` pairs, of the street that the library simulates: the truth is exact.
std::vector<ScanPair> streetPairs(std::size_t step, std::size_t most);
/// The same of the PCD files of a directory, references from their VIEWPOINTs. Empty if
/// there is no such directory.
std::vector<ScanPair> filePairs(const std::filesystem::path& directory, std::size_t step, std::size_t most);

/// Where a search starts from: the reference, moved and turned in any direction.
struct Offset {
  double translation, degrees;  ///< exactly so far, or at most (uniform)
  bool at_most;
};
Pose startFrom(const Pose& reference, const Offset& offset, std::uint64_t seed);

/// How far a pose is from the reference.
struct PoseError {
  double metres, degrees;
};
PoseError errorOf(const Pose& pose, const Pose& reference);

}  // namespace gaussmap::benchmark
