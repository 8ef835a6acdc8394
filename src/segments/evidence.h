// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/cell_row.h"

namespace gaussmap::detail {

using Particle = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;

/// The observations of a segment, in the form of its EvidencePolicy.
struct SegmentEvidence {
  CellRow row;                      ///< moments per cell along the segment
  std::vector<Particle> particles;  ///< EvidencePolicy::ParticleSets only: `row` contains their moments

  /// Returns the evidence in the cells [first, last) of the row.
  SegmentEvidence slice(std::size_t first, std::size_t last) const;
  void absorb(const SegmentEvidence& other);
  std::size_t bytes() const { return row.bytes() + particles.capacity() * sizeof(Particle); }
};

/// Converts observations to evidence.
class EvidenceKeeper {
 public:
  virtual ~EvidenceKeeper() = default;
  /// Adds an observation to a segment of this length [m]. `number` is the number of the observation; it seeds the
  /// random choice of the particles that make room for it.
  virtual void add(const std::vector<ObservationPoint>& observation, double length, std::uint64_t number,
                   SegmentEvidence& evidence) const = 0;
  /// Call it after all observations of a scan. Drops the evidence beyond a limit that holds for parts of a segment, and
  /// computes the row. `number` must be different for every call; it seeds the random choice.
  virtual void settle(std::uint64_t number, SegmentEvidence& evidence) const = 0;
};

std::unique_ptr<EvidenceKeeper> makeEvidenceKeeper(const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
