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

/// Options for finding the cells that a scan hits and the cells that its beams pass through.
struct GAUSSMAP_API ScanEvidenceOptions {
  /// Points farther from the sensor hit no cell [m]. Their beams still pass through the cells in front of them.
  double max_range = std::numeric_limits<double>::infinity();
  std::optional<Projection> projection;     ///< for every scan; std::nullopt: findProjection() of each scan
  std::optional<double> no_return_is_free;  ///< see RangeImage::noReturnIsFree(); std::nullopt: not called
  VisibilityOptions visibility;             ///< when a beam passes through a cell
  int threads = 0;                          ///< 0 = all cores
  /// Points nearer to the sensor hit no cell [m]. They still hide what is behind them.
  double min_range = 0.0;
  /// Points outside this box hit no cell [m, map frame]. Their beams still pass through cells.
  std::optional<Box<3>> crop = std::nullopt;
};

/// The observations of the finest cells of a map by all scans together. For each scan, coarse cells are tested first.
/// The finest cells below a coarse cell are skipped if no beam can pass through it (culling).
struct ScanEvidence {
  std::vector<Evidence> cells;    ///< one entry per finest cell of the map
  std::size_t camera_scans = 0;   ///< number of scans with a PlanarProjection
  std::size_t cells_tested = 0;   ///< number of tests of coarse cells, over all scans
  std::size_t cells_visited = 0;  ///< number of tests of finest cells, over all scans
};

/// Decides which cells held an object that has moved. If a length is std::nullopt, its default depends on the side of
/// the finest cells, as explained at VisibilityOptions.
struct MovingCellOptions {
  OccupancyOptions occupancy;  ///< log-odds per hit and per miss
  double min_points = 10.0;    ///< a group of connected freed cells with fewer points is noise, not an object
  /// The same limit if a scan is from a depth camera, at least min_points. It is about the number of points of a patch
  /// of 7 x 7 pixels: three standard deviations of the lateral noise to each side. One is about 1 pixel (Nguyen 2012).
  double min_points_of_camera = 50.0;
  /// Cells up to this far apart are connected [m]; adjacent cells always are. std::nullopt: 0.2 m; 2 cells for cells of
  /// 2 mm and less.
  std::optional<double> link = std::nullopt;
  /// Maximum distance of the cells of an object from one of its freed cells [m], between the means of their points.
  /// std::nullopt: 0.5 m; 5 cells for cells of 2 mm and less.
  std::optional<double> reach = std::nullopt;
};

/// Separates the points of an object from those of a floor or wall in the same cell. The scans before and after the
/// object was in the cell define the surface of the floor or wall. If a length is std::nullopt, its default depends on
/// the side of the finest cells, as explained at VisibilityOptions.
struct SharedCellOptions {
  /// Cells within this distance can contribute points to the surface [m]. std::nullopt: 0.6 m; 6 cells for cells of 2
  /// mm and less.
  std::optional<double> reach = std::nullopt;
  /// Maximum standard deviation of the points across a surface [m]. std::nullopt: 0.04 m; 0.4 cells for cells of 2 mm
  /// and less.
  std::optional<double> flatness = std::nullopt;
  /// Maximum distance between the surface and a point that belongs to it [m]. Three standard deviations across the
  /// surface are used instead if they are larger. std::nullopt: 0.01 m; 0.1 cells for cells of 2 mm and less.
  std::optional<double> noise = std::nullopt;
  /// Minimum standard deviation of the points along the second axis of a surface [m]. std::nullopt: 0.05 m; 0.5 cells
  /// for cells of 2 mm and less.
  std::optional<double> extent = std::nullopt;
};

/// Options of MovingPoints.
struct MovingPointOptions {
  double resolution = 0.2;       ///< side of the finest cells [m]
  ScanEvidenceOptions evidence;  ///< options of the step `evidence`
  MovingCellOptions cells;       ///< options of the steps `free` and `grow`
  SharedCellOptions shared;      ///< options of the step `share`
};

/// One of the three times that MovingPoints reads all scans.
enum class MovingPointStep {
  Counting,  ///< builds the map
  Looking,   ///< finds the cells that each scan hits and passes through
  Sharing    ///< collects the points of surfaces beside moving objects
};

/// Finds the points of scans that lie on moving objects. The class keeps the map, but not the scans.
///
/// It works in five steps:
/// - map: builds the map of all scans.
/// - evidence: finds which finest cells each scan hits and which it passes through. A scan with a point in a cell hits
///   the cell, whatever its other beams do. Any other scan passes through the cell if its beams pass through the mean
///   of the cell's points (see visibilityOf()). This is the method of Yguel 2009, sec. 4.1 and 4.2, but it tests only
///   this one place per cell.
/// - free: frees a cell if at least one scan hit it, but its log-odds over all scans are below 0. Connected groups of
///   freed cells with few points are noise of the sensor or the poses. They are not freed.
/// - grow: adds cells near a freed cell. All scans that hit such a cell lie between the first and the last scan that
///   hit the freed cell. The cell then belongs to the same object, even if no beam has passed through it since, for
///   example on the far side of the object.
/// - share: fits a surface to the static points in and around each cell of an object. While the object was there, only
///   the points off this surface are moving. This holds for the cells of the object and the cells adjacent to them. If
///   there is no flat surface, all points in the cells of the object are moving.
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
  /// Points that are not returns, or lie outside the range limits or the box, are not moving. The function reads the
  /// scan again and is thread-safe. Throws FileError if a file is damaged, and std::out_of_range if there is no such
  /// scan.
  std::vector<bool> inScan(std::size_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What freePoints() assumes about places where the map has no cell.
enum class UnknownSpace {
  Automatic,  ///< free if the map has a surface behind the place, as seen from the sensor; otherwise occupied
  Keep,       ///< occupied: points there are never free
  Remove      ///< free, even if no scan has seen the place
};

/// Options of freePoints().
struct FreePointOptions {
  float threshold = 0.0f;  ///< a place is free if its log-odds of occupancy are below this value
  UnknownSpace unknown = UnknownSpace::Automatic;  ///< what is assumed of places without a cell
  VisibilityOptions visibility;  ///< UnknownSpace::Automatic: how clearly a surface must lie behind a free place
  int threads = 0;               ///< 0 = all cores
};

/// Returns one flag per point of a scan: true if the map shows that the place of the point is free. A point at a free
/// place belongs to an object that moves or is new.
///
/// `points` [m, map frame] are the points of the scan, and `sensor` [m, map frame] is the position of its sensor.
/// Points that are not finite get false. A place where the map has a cell is free if its log-odds are below
/// FreePointOptions::threshold. A map of OnlineMapper has no cells where it has forgotten an object, so most free
/// places have no cell. With UnknownSpace::Automatic, two rules decide about a place without a cell:
/// - It is free if the nearest surfaces of the map in its direction lie clearly behind it. For this test, the means of
///   the leaves that are not free are drawn into a range image with pixels of 1 degree, as seen from `sensor` (see
///   visibilityOf()). The map has usually seen these surfaces through the place, if its sensors were near `sensor`.
/// - It is also free if a chain of at most four adjacent cubes connects it to a free place. The side of a cube is
///   the default of MovingCellOptions::link. Each cube of the chain must hold a free point or a point without a cell.
///   This rule finds the edges and the feet of an object.
///
/// So a static object that the map has not seen gets false, unless it stands in front of a surface of the map. Throws
/// std::invalid_argument if UnknownSpace::Automatic needs the position of the sensor and it is not finite.
GAUSSMAP_API std::vector<bool> freePoints(const GaussianMap<3>& map, const std::vector<Eigen::Vector3d>& points,
                                          const Eigen::Vector3d& sensor, const FreePointOptions& options = {});

}  // namespace gaussmap
