// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// Pairs the Gaussians of a scan with the nearest ones of a map, for any pose of the scan. Keeps references to
/// the scan and to the neighbours.
class ScanOnMap {
 public:
  ScanOnMap(const std::vector<Gaussian<3>>& scan, MapNeighbours& near, double kernel, int threads)
      : scan_(scan), near_(near), kernel_(kernel), threads_(threads), lists_(scan.size(), MapNeighbours::kNone) {}

  /// Returns the normal equations at a pose (relative to the origin of the neighbours).
  NormalEquations linearise(const Pose& pose);

 private:
  const std::vector<Gaussian<3>>& scan_;
  MapNeighbours& near_;
  const double kernel_;
  const int threads_;
  std::vector<std::uint32_t> lists_;  // last list of each Gaussian; most Gaussians stay in it
};

}  // namespace gaussmap::detail
