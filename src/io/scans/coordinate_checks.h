// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// Keeps some points of each scan while the scans are read, so that no scan is read twice. The chosen points do not
/// depend on the order of the reads. All functions are thread-safe.
class CoordinateSamples {
 public:
  explicit CoordinateSamples(std::size_t scans);

  /// Takes points from a block of scan `scan` that starts at point `first`. `size`: points of the scan.
  void add(std::size_t scan, std::size_t first, const PointBlock<3>& block, std::size_t size);

  /// Returns the finite points of a scan, in the frame of its file.
  std::vector<Eigen::Vector3d> of(std::size_t scan) const;

 private:
  std::size_t per_scan_;
  mutable std::mutex mutex_;
  std::vector<std::vector<Eigen::Vector3d>> points_;
};

/// Some points of one file, in its frame [m].
struct SampledScan {
  std::filesystem::path path;
  bool is_ascii = false;
  std::vector<Eigen::Vector3d> points;
};

/// Returns one warning per kind of fault:
/// - Coordinates that are 32-bit floats, or were so before, and whose step is larger than a tenth of `resolution` [m].
/// - Coordinates that look like millimetres: they spread over hundreds of metres in all directions, or over more than
///   100 m if all are whole numbers.
std::vector<std::string> warningsOf(const std::vector<SampledScan>& scans, double resolution);

}  // namespace gaussmap::detail
