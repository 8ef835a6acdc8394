// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/cell_row.h"

namespace gaussmap::detail {

using Particle = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;

/// The observations of a segment, in one of two forms.
struct SegmentEvidence {
  CellRow row;                      ///< where it lies; all there is with EvidencePolicy::MomentCells
  std::vector<Particle> particles;  ///< with EvidencePolicy::ParticleSets: what `row` is made of

  /// The evidence in the cells [first, last) of the row.
  SegmentEvidence slice(std::size_t first, std::size_t last) const;
  void absorb(const SegmentEvidence& other);
  std::size_t bytes() const { return row.bytes() + particles.capacity() * sizeof(Particle); }
};

/// How observations become evidence.
class EvidenceKeeper {
 public:
  virtual ~EvidenceKeeper() = default;
  virtual void add(const std::vector<ObservationPoint>& observation, SegmentEvidence& evidence) const = 0;
  /// After all observations of a scan: forgets evidence beyond the limit for a segment of this length [m]. `number` is
  /// different for every call.
  virtual void settle(double length, std::uint64_t number, SegmentEvidence& evidence) const = 0;
};

std::unique_ptr<EvidenceKeeper> makeEvidenceKeeper(const SegmentFitterOptions& options);

}  // namespace gaussmap::detail
