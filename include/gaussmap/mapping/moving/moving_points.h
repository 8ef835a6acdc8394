// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "gaussmap/mapping/accumulate_scans.h"
#include "gaussmap/mapping/moving/moving_cells.h"
#include "gaussmap/mapping/moving/scan_evidence.h"

namespace gaussmap {

struct MovingPointOptions {
  double resolution = 0.2;  ///< side of the finest cells [m]
  ScanEvidenceOptions evidence;
  MovingCellOptions cells;
  SharedCellOptions shared;
};

enum class MovingPointStep { Counting, Looking, Sharing };

/// Finds the points of scans that lie on moving objects: builds the map of all scans, asks which of its finest cells
/// the other scans passed through (gatherEvidence()), takes the objects out whole (findMovingCells()), and splits the
/// cells that an object shares with what it stood on. Holds the map, not the scans.
class MovingPoints {
 public:
  /// Reads all scans three times. `progress` is called with the scans done of a step.
  /// Throws FileError, std::out_of_range as accumulateScans(), std::invalid_argument, naming the option.
  explicit MovingPoints(std::shared_ptr<const Scans> scans, const MovingPointOptions& options = {},
                        const std::function<void(MovingPointStep, std::size_t)>& progress = {});
  ~MovingPoints();
  MovingPoints(MovingPoints&&) noexcept;
  MovingPoints& operator=(MovingPoints&&) noexcept;

  const Scans& scans() const;
  const PointCounts& counts() const;
  const GaussianMap<3>& map() const;
  const ScanEvidence& evidence() const;
  /// Of the finest cells of the map.
  const std::vector<bool>& movingCells() const;

  /// One flag a point of scan `index`, in its order. Points that are no returns, or beyond max_range, are
  /// not moving. Reads the scan again. Thread-safe. Throws FileError; std::out_of_range if there is no such scan.
  std::vector<bool> inScan(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
