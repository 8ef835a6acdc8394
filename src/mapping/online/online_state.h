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
  std::vector<std::uint32_t> new_cells;  // of them, those not there before
  std::vector<std::uint32_t> missed;     // finest cells that beams passed through; may contain a cell twice
  std::optional<MomentGrid<D>> sums;     // of its points; LearningRate::SampleMean only
};

/// The sums of a recent scan, kept to take its points out of the map again.
template <int D>
struct ScanSums {
  std::uint32_t number;
  MomentGrid<D> sums;
};

/// A finest cell of an object that has gone.
template <int D>
struct GoneCell {
  CellKey<D> key;
  Evidence evidence;
  float log_odds;
};

/// A range image and where it was taken.
struct SensorView {
  SensorView(RangeImage seen, const Pose& from)
      : image(std::move(seen)), pose(from), to_sensor(from.rotation.toRotationMatrix().transpose()) {}

  RangeImage image;
  Pose pose;
  Eigen::Matrix3d to_sensor;

  /// Map frame to sensor frame.
  Eigen::Vector3d toSensor(const Eigen::Vector3d& point) const { return to_sensor * (point - pose.translation); }
};

/// A point of the map in space: in the plane, at the height of the sensor.
inline Eigen::Vector3d inSpace(const Vector<3>& point, const Pose&) {
  return point;
}
inline Eigen::Vector3d inSpace(const Vector<2>& point, const Pose& sensor) {
  return {point.x(), point.y(), sensor.translation.z()};
}

/// Points into cells: Yguel 2009, sec. 4.3 and 4.4, Algorithm 1. Fills `touched` and `new_cells`.
template <int D>
void updateByPoints(OnlineCells<D>& cells, OnlineScan<D>& scan, const OnlineOptions& options);

/// Puts a deleted finest cluster back; if its cell is occupied again meanwhile, adds it to what is there.
template <int D>
void restoreCell(OnlineCells<D>& cells, const RemovedCluster<D>& removed, const OnlineOptions& options);

/// Tests the new cells against the range images of the scans before.
template <int D>
void lookBack(OnlineCells<D>& cells, OnlineScan<D>& scan, const std::deque<SensorView>& views,
              const OnlineOptions& options);

/// Counts a hit for every cluster with one of these finest cells under it.
template <int D>
void countHits(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<std::uint32_t>& touched,
               const OnlineOptions& options);

/// Counts a miss for every cluster that the scan did not hit and passes through, Yguel 2009, sec. 4.1 and 4.2.
template <int D>
void countMisses(OnlineCells<D>& cells, OnlineScan<D>& scan, const SensorView& view, const OnlineOptions& options,
                 OnlineStatistics& statistics);

/// Deletes clusters with log-odds below 0 and the rest of their objects, Yguel 2009, sec. 5.3. Returns the finest cells
/// deleted.
template <int D>
std::vector<GoneCell<D>> forget(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                                const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics);

/// Takes what the last scans saw of the object out of the cells beside it, where that lies off their surface.
template <int D>
void splitSharedCells(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<GoneCell<D>>& gone,
                      std::deque<ScanSums<D>>& recent, const OnlineOptions& options,
                      const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics);

/// Looks at the coarse cells with points of the scan, and gives clusters to the cells of the map that are known to need
/// them most; Yguel 2009, sec. 5.1 (there: to the visible cells only).
template <int D>
void refineVisible(OnlineCells<D>& cells, const OnlineScan<D>& scan, const OnlineOptions& options,
                   OnlineStatistics& statistics);

/// Gives a coarse cell other clusters: `references` (about its centre), labels = which of them each finer cluster under
/// it belongs to. Each takes over what is known of the old cluster that most of its members come from.
template <int D>
void recluster(OnlineCells<D>& cells, std::uint32_t i, int scale, const std::vector<Gaussian<D>>& references,
               const std::vector<int>& labels);

/// What a hit or a miss does to a cluster.
template <int D>
void hit(OnlineCluster<D>& cluster, std::uint32_t scan, const OccupancyOptions& options) {
  if (cluster.evidence.hits > 0 && cluster.evidence.last_hit == scan) return;
  cluster.evidence.hit(scan);
  cluster.log_odds = static_cast<float>(std::min(options.max_log_odds, double(cluster.log_odds) + options.hit));
}
template <int D>
void miss(OnlineCluster<D>& cluster, double share, const OccupancyOptions& options) {
  if (share > 0.5) cluster.evidence.miss();
  cluster.log_odds =
      static_cast<float>(std::max(-options.max_log_odds, double(cluster.log_odds) - share * options.miss));
}

}  // namespace gaussmap::detail
