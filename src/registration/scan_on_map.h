// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// The Gaussians of a scan, each beside the nearest one of a map wherever the scan is put. Refers to what it is made
/// of.
class ScanOnMap {
 public:
  ScanOnMap(const std::vector<Gaussian<3>>& scan, MapNeighbours& near, double kernel, int threads)
      : scan_(scan), near_(near), kernel_(kernel), threads_(threads), lists_(scan.size(), MapNeighbours::kNone) {}

  /// The normal equations at a pose (about the origin of the neighbours).
  NormalEquations linearise(const Pose& pose);

 private:
  const std::vector<Gaussian<3>>& scan_;
  MapNeighbours& near_;
  const double kernel_;
  const int threads_;
  std::vector<std::uint32_t> lists_;  // where the Gaussians were last: most of them stay there
};

}  // namespace gaussmap::detail
