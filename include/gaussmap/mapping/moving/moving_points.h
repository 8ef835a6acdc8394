// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/sensor/projection.h"
#include "gaussmap/sensor/visibility.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// How the scans are asked which cells they hit and which they passed through.
struct GAUSSMAP_API ScanEvidenceOptions {
  double max_range = std::numeric_limits<double>::infinity();  ///< farther points hit no cell, but free the way [m]
  std::optional<Projection> projection;     ///< of every scan; nullopt: found for each scan from its points
  std::optional<double> no_return_is_free;  ///< pixels without return are free space up to this range [m]
  VisibilityOptions visibility;
  int threads = 0;  ///< 0 = all cores
};

/// What all scans together say about the finest cells of a map.
struct ScanEvidence {
  std::vector<Evidence> cells;    ///< of the finest cells of the map, in their order
  std::size_t cells_tested = 0;   ///< cells of the coarser scales that culling tested, summed over the scans
  std::size_t cells_visited = 0;  ///< finest cells that culling left to look at, summed over the scans
};

/// Which cells held an object that has moved. Lengths are in metres: the same length at every resolution.
struct MovingCellOptions {
  OccupancyOptions occupancy;
  double min_points = 10.0;  ///< connected groups of freed cells with fewer points are noise and are kept
  double link = 0.2;         ///< cells this close to each other are connected [m], at least one cell
  double reach = 0.5;        ///< how far an object extends beyond its freed cells, at most [m]
};

/// How points are told apart in a cell that an object shares with a floor or wall: by the surface that the scans
/// measured while the object was not there.
struct SharedCellOptions {
  double reach = 0.6;      ///< cells up to this far away may help to find the surface [m]
  double flatness = 0.04;  ///< largest standard deviation across the surface [m]: beyond it there is no surface
  double noise = 0.01;     ///< a point within this or three standard deviations of the surface belongs to it [m]
};

struct MovingPointOptions {
  double resolution = 0.2;  ///< side of the finest cells [m]
  ScanEvidenceOptions evidence;
  MovingCellOptions cells;
  SharedCellOptions shared;
};

enum class MovingPointStep { Counting, Looking, Sharing };

/// Finds the points of scans that lie on moving objects. It keeps the map, not the scans. Five steps:
/// - map: the map of all scans;
/// - evidence: which of its finest cells each scan hit and which it passed through. A scan with a point in a cell hits
///   the cell, whatever its other beams do. Any other scan passes through the cell if it passes through the mean of
///   the cell's points (visibilityOf()). Yguel 2009, sec. 4.1 and 4.2, with one sample per cell;
/// - free: a cell is freed if some scan hit it, but the log-odds of all scans are below 0. Connected groups of freed
///   cells with few points are noise of sensor or pose, and are restored;
/// - grow: a cell beside a freed one that was seen only while that one was is of the same object, though no beam has
///   passed there since (the object's lower parts, its far side);
/// - share: in the cells that an object shares with the surface that it stood on, the points off the surface move.
class GAUSSMAP_API MovingPoints {
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
  /// One flag per finest cell of the map.
  const std::vector<bool>& movingCells() const;

  /// One flag per point of scan `index`, in its order. Points that are not returns, or beyond max_range, are not
  /// moving. Reads the scan again. Thread-safe. Throws FileError; std::out_of_range if there is no such scan.
  std::vector<bool> inScan(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
