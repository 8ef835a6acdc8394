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

/// Options of the test which cells a scan hits and which cells its beams pass through.
struct GAUSSMAP_API ScanEvidenceOptions {
  /// Points farther from the sensor hit no cell [m]. Their beams still pass through the cells in front of them.
  double max_range = std::numeric_limits<double>::infinity();
  std::optional<Projection> projection;     ///< of every scan; std::nullopt: determined from the points of each scan
  std::optional<double> no_return_is_free;  ///< pixels without return are free space up to this range [m]
  VisibilityOptions visibility;             ///< when a beam passes through a cell
  int threads = 0;                          ///< 0 = all cores
};

/// The observations of the finest cells of a map by all scans together.
struct ScanEvidence {
  std::vector<Evidence> cells;    ///< per finest cell of the map
  std::size_t camera_scans = 0;   ///< number of scans with a PlanarProjection
  std::size_t cells_tested = 0;   ///< cells of the coarser scales that the culling tested, summed over the scans
  std::size_t cells_visited = 0;  ///< finest cells that remained after the culling, summed over the scans
};

/// Decides which cells held an object that has moved. Lengths are in metres, so they do not change with the resolution.
struct MovingCellOptions {
  OccupancyOptions occupancy;  ///< log-odds per hit and per miss
  double min_points = 10.0;    ///< connected groups of freed cells with fewer points are noise and are kept
  /// The same limit if a scan is from a depth camera, at least min_points. It is a patch of 7 x 7 pixels: three
  /// standard deviations of the lateral noise to each side, about 1 pixel each (Nguyen 2012).
  double min_points_of_camera = 50.0;
  double link = 0.2;   ///< cells within this distance are connected [m], at least one cell
  double reach = 0.5;  ///< maximum distance that an object extends beyond its freed cells [m]
};

/// Separates the points of an object from those of a floor or wall in the same cell. The scans that did not see the
/// object in the cell define the surface of the floor or wall.
struct SharedCellOptions {
  double reach = 0.6;      ///< cells within this distance can contribute points to the surface [m]
  double flatness = 0.04;  ///< maximum standard deviation across the surface [m]; above, there is no surface
  double noise = 0.01;     ///< points within this or three standard deviations belong to the surface [m]
};

/// Options of MovingPoints.
struct MovingPointOptions {
  double resolution = 0.2;       ///< side of the finest cells [m]
  ScanEvidenceOptions evidence;  ///< for step evidence
  MovingCellOptions cells;       ///< for steps free and grow
  SharedCellOptions shared;      ///< for step share
};

/// A pass of MovingPoints over all scans.
enum class MovingPointStep {
  Counting,  ///< builds the map
  Looking,   ///< finds the cells that each scan hits and passes through
  Sharing    ///< collects the points of surfaces beside moving objects
};

/// Finds the points of scans that lie on moving objects. The class keeps the map, but not the scans.
///
/// It works in five steps:
/// - map: builds the map of all scans.
/// - evidence: finds which finest cells each scan hit and which it passed through. A scan with a point in a cell hits
///   the cell, whatever its other beams do. Any other scan passes through the cell if its beams pass through the mean
///   of the cell's points (see visibilityOf()). This is Yguel 2009, sec. 4.1 and 4.2, with one sample per cell.
/// - free: frees a cell if at least one scan hit it, but its log-odds over all scans are below 0. Connected groups of
///   freed cells with few points are noise of sensor or pose and are kept.
/// - grow: adds the cells near a freed cell that were hit only while the freed cell was hit. They belong to the same
///   object, even if no beam has passed through them since (lower parts, far side).
/// - share: in cells that an object shares with the surface below or beside it, only the points off the surface are
///   moving.
class GAUSSMAP_API MovingPoints {
 public:
  /// Runs all steps and reads all scans three times.
  ///
  /// `progress` is called with the step and the number of scans done in this step. Throws FileError if a file is
  /// damaged, std::out_of_range like accumulateScans(), and std::invalid_argument if an option is out of range (the
  /// message names the option).
  explicit MovingPoints(std::shared_ptr<const Scans> scans, const MovingPointOptions& options = {},
                        const std::function<void(MovingPointStep, std::size_t)>& progress = {});
  ~MovingPoints();
  MovingPoints(MovingPoints&&) noexcept;
  MovingPoints& operator=(MovingPoints&&) noexcept;

  /// Returns the scans.
  const Scans& scans() const;
  /// Returns the counts of accepted and dropped points.
  const PointCounts& counts() const;
  /// Returns the map of all scans, including the moving objects.
  const GaussianMap<3>& map() const;
  /// Returns the observations of the finest cells.
  const ScanEvidence& evidence() const;
  /// Returns one flag per finest cell of the map: true if the cell held a moving object.
  const std::vector<bool>& movingCells() const;

  /// Returns one flag per point of scan `index`, in the order of the points: true if the point is moving.
  ///
  /// Points that are not returns or lie beyond max_range are not moving. The function reads the scan again and is
  /// thread-safe. Throws FileError if a file is damaged, and std::out_of_range if there is no such scan.
  std::vector<bool> inScan(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
