// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/sensor/range_image.h"
#include "mapping/learning_rate.h"
#include "mapping/online/online_cells.h"
#include "sensor/culling.h"

// The steps of OnlineMapper::add(), one file each.
namespace gaussmap::detail {

/// The scan that is being added to the map.
template <int D>
struct OnlineScan {
  std::uint32_t number = 0;
  Pose pose;
  std::vector<Vector<D>> points;         // returns [m, map frame]
  std::vector<std::uint32_t> touched;    // finest cells with points, in the order they were touched
  std::vector<std::uint32_t> new_cells;  // touched cells that did not exist before
  std::vector<std::uint32_t> missed;     // finest cells that beams passed through; may contain a cell twice
  std::optional<MomentGrid<D>> sums;     // moments of the points; LearningRate::SampleMean only
};

/// The moments of a recent scan, kept so that its points can be removed from the map.
template <int D>
struct ScanSums {
  std::uint32_t number;
  MomentGrid<D> sums;
};

/// A deleted finest cell of an object that has moved away.
template <int D>
struct GoneCell {
  CellKey<D> key;
  Evidence evidence;
  float log_odds;
};

/// A range image and the pose of the sensor.
struct SensorView {
  SensorView(RangeImage seen, const Pose& from)
      : image(std::move(seen)), pose(from), to_sensor(from.rotation.toRotationMatrix().transpose()) {}

  RangeImage image;
  Pose pose;
  Eigen::Matrix3d to_sensor;

  /// Transforms a point from the map frame to the sensor frame [m].
  Eigen::Vector3d toSensor(const Eigen::Vector3d& point) const { return to_sensor * (point - pose.translation); }
};

/// Returns a point of the map as a 3-D point. A point of a 2-D map gets the height of the sensor.
inline Eigen::Vector3d inSpace(const Vector<3>& point, const Pose&) {
  return point;
}
inline Eigen::Vector3d inSpace(const Vector<2>& point, const Pose& sensor) {
  return {point.x(), point.y(), sensor.translation.z()};
}

/// Adds the points of a scan to their cells, Yguel 2009, sec. 4.3 and 4.4, Algorithm 1. Sets scan.touched,
/// scan.new_cells and scan.sums. Throws std::out_of_range if a point lies beyond the range of 32-bit cell indices; the
/// map does not change then.
template <int D>
void updateByPoints(OnlineCells<D>& cells, OnlineScan<D>& scan, const OnlineOptions& options);

/// Puts a deleted finest cluster back. If its cell exists again, the cluster is added to the cluster of the cell.
template <int D>
void restoreCell(OnlineCells<D>& cells, const RemovedCluster<D>& removed, const OnlineOptions& options);

/// Tests the new cells against the range images of earlier scans.
template <int D>
void lookBack(OnlineCells<D>& cells, OnlineScan<D>& scan, const std::deque<SensorView>& views,
              const OnlineOptions& options);

/// Returns B, Yguel 2009 eq. (1): the number of pixels that the ball around a cell can cover, at least 1, at most
/// `most`. `range` = distance of the cell from the sensor [m], `side` = side of the cell [m]. The paper measures pixels
/// on the plane of the image; for a lidar, this is the unit sphere.
int samplesFor(const Projection& projection, double range, double side, double most);

/// HitRule::Points: counts a hit for the clusters of the finest cells `touched` and for all their ancestors, once per
/// cluster.
template <int D>
void countHits(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<std::uint32_t>& touched,
               const OnlineOptions& options);

/// Tests the visible clusters against the range image of the scan, Yguel 2009, sec. 4.1 and 4.2. HitRule::Points:
/// counts a miss for every cluster that the scan did not hit and that its beams passed through. HitRule::RangeImage:
/// raises and lowers the log-odds of all of them, and counts hits and misses.
template <int D>
void testVisible(OnlineCells<D>& cells, OnlineScan<D>& scan, const SensorView& view, const OnlineOptions& options,
                 OnlineStatistics& statistics);

/// Deletes the finest clusters with log-odds below the limit and the other cells of their objects, Yguel 2009,
/// sec. 5.3. Also deletes coarser clusters without children. Returns the deleted finest cells.
template <int D>
std::vector<GoneCell<D>> forget(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                                const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics);

/// Removes the points of deleted objects from the cells beside them. In each such cell, the function tests the points
/// of the `recent` scans that may have seen the object. It removes the points of a scan if they lie off the surface in
/// the cell.
template <int D>
void splitSharedCells(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<GoneCell<D>>& gone,
                      std::deque<ScanSums<D>>& recent, const OnlineOptions& options,
                      const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics);

/// Measures the need for clusters of the coarse cells with points of the scan. Then adds clusters to the cells with the
/// largest known need, Yguel 2009, sec. 5.1: to those of the whole map or of the scan, see RefineArea.
template <int D>
void refineVisible(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                   OnlineStatistics& statistics);

/// Replaces the clusters of a coarse cell by `centres` (means about the centre of the cell [m]). `labels` = new
/// cluster of each finer cluster under the cell. A new cluster takes over the occupancy, evidence and parent of the old
/// cluster with the largest part of its weight.
template <int D>
void recluster(OnlineCells<D>& cells, std::uint32_t i, int scale, const std::vector<Gaussian<D>>& centres,
               const std::vector<int>& labels);

/// Returns the learning rate eps(o), Yguel 2009 eq. (5).
inline double rateOf(double log_odds, const OnlineOptions& options) {
  return LearningRates{options.slowest_rate, options.fastest_rate, options.occupancy.max_log_odds}.at(log_odds);
}

/// Counts a hit of a cluster by a scan, at most once per scan, and raises its log-odds.
template <int D>
void hit(OnlineCluster<D>& cluster, std::uint32_t scan, const OccupancyOptions& options) {
  if (cluster.evidence.hits > 0 && cluster.evidence.last_hit == scan) return;
  cluster.evidence.hit(scan);
  cluster.log_odds = static_cast<float>(std::min(options.max_log_odds, double(cluster.log_odds) + options.hit));
}
/// Lowers the log-odds of a cluster. `share` = fraction of its samples that beams passed through; above 0.5, it counts
/// as a miss.
template <int D>
void miss(OnlineCluster<D>& cluster, double share, const OccupancyOptions& options) {
  if (share > 0.5) cluster.evidence.miss();
  cluster.log_odds =
      static_cast<float>(std::max(-options.max_log_odds, double(cluster.log_odds) - share * options.miss));
}

}  // namespace gaussmap::detail
