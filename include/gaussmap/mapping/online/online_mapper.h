// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/sensor/projection.h"
#include "gaussmap/sensor/visibility.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// How far a point moves its cluster.
enum class LearningRate {
  SampleMean,  ///< 1 / n: a cluster is the exact moments of its points, independent of their order
  Occupancy    ///< Yguel 2009 eq. (5): slowly where the map was often observed, faster where it is uncertain
};

/// What raises the occupancy of a cluster.
enum class HitRule {
  /// A point of the scan in a finest cell hits the cluster of this cell and all its ancestors. Range images only lower
  /// the occupancy, and only that of other clusters.
  Points,
  /// The range image decides, as in Yguel 2009 sec. 4.1: samples at the surface that the beams hit raise the occupancy,
  /// samples that the beams passed through lower it, and others change nothing. A cluster changes by the mean over its
  /// samples. Each cluster of each scale is tested by itself, so the cluster that learns has its own occupancy.
  RangeImage
};

/// The points of a cluster that are tested against a range image.
enum class OccupancySamples {
  Mean,   ///< the mean of the cluster
  Random  ///< random samples, one per pixel that can see the cell, Yguel 2009 eq. (1): slower
};

/// The place whose distance from the sensor gives the number of random samples, delta in eq. (1).
enum class SampleRange {
  Mean,       ///< the mean of the cluster
  CellCentre  ///< the centre of the cell of the cluster, as in Yguel 2009
};

/// The factor of a finer cluster in the error of a coarse cell, Yguel 2009 eq. (6).
enum class ErrorFactor {
  One,          ///< all finer clusters count alike
  OneMinusRate  ///< 1 - eps, with the learning rate of eq. (5); LearningRate::Occupancy only
};

/// The coarse cells that a refinement can give clusters to.
enum class RefineArea {
  Known,   ///< all cells of the map; their need is that of the last refinement that touched them
  Visible  ///< cells with points of the present scan, Yguel 2009 sec. 5.1
};

/// Options of OnlineMapper.
struct GAUSSMAP_API OnlineOptions {
  MapOptions map;                                              ///< cells of the map
  double max_range = std::numeric_limits<double>::infinity();  ///< points farther from the sensor are ignored [m]
  double min_range = 0.0;  ///< points nearer to the sensor are ignored, but hide what is behind them [m]
  std::optional<Box<3>> crop = std::nullopt;  ///< points outside this box are ignored, their beams not [m, map frame]
  LearningRate learning_rate = LearningRate::SampleMean;  ///< how far a point moves its cluster
  double slowest_rate = 5e-4;  ///< eps_min of eq. (5), LearningRate::Occupancy only, in (0, 1]
  double fastest_rate = 5e-2;  ///< eps_max of eq. (5), LearningRate::Occupancy only, in [slowest_rate, 1]

  OccupancyOptions occupancy;                         ///< log-odds per hit and per miss
  HitRule hit_rule = HitRule::Points;                 ///< what raises the occupancy of a cluster
  VisibilityOptions visibility;                       ///< when a beam passes through a cluster
  OccupancySamples samples = OccupancySamples::Mean;  ///< which points of a cluster are tested
  SampleRange sample_range = SampleRange::Mean;       ///< OccupancySamples::Random only: delta of eq. (1)
  /// Maximum number of random samples per cluster, >= 0. 0: only the number of pixels of the range image, because B of
  /// eq. (1) has no limit close to the sensor.
  int max_samples = 100;
  /// Projection of every scan; std::nullopt: determined from the points, and again if a scan does not fit it.
  std::optional<Projection> projection;
  /// Pixels without return are free space up to this range [m]; std::nullopt: they show nothing.
  std::optional<double> no_return_is_free;
  std::vector<double> max_ranges;  ///< per scale: cells farther from the sensor are not tested [m]; empty: no limit
  int occupancy_every = 1;         ///< the occupancy is updated every this many scans, >= 1
  /// Number of recent scans that are kept, >= 0. Their range images show whether beams have passed through a new cell
  /// before. Their sums of points per cell are used by `shared`, which needs at least 1.
  int look_back = 10;

  /// Deletes finest clusters that a scan has lowered below `forget_below`, and the other cells of their objects, then
  /// coarse clusters without children. The object of such a cell: connected cells that were hit only between its first
  /// and its last hit.
  bool forget = true;
  double forget_below = 0.0;  ///< limit of the deletion [log-odds], between -max_log_odds and max_log_odds
  /// From one connected cell to the next, at most this [m] or one cell; std::nullopt: see MovingCellOptions::link.
  std::optional<double> link = std::nullopt;
  /// Maximum distance of these cells from that below the limit [m]; std::nullopt: see MovingCellOptions::reach.
  std::optional<double> reach = std::nullopt;
  /// In cells beside a deleted object that also hold a surface (floor or wall): deletes the points off the surface from
  /// those of the last look_back scans that can have seen the object. Needs `forget` and LearningRate::SampleMean.
  SharedCellOptions shared;

  int refine_every = 10;  ///< the coarse scales are refined every this many scans; 0 = never
  /// p, maximum number of clusters added per scale and refinement; 0: as many as the budget allows. With p = 4, as in
  /// the paper, the coarse scales have only a third of the Gaussians of their budget after a drive of 20 scans.
  std::size_t refine_cells = 0;
  double budget = 3.0;  ///< maximum Gaussians of a coarse scale after a refinement, as a multiple of its cells, >= 1
  RefineMethod method = RefineMethod::Agglomerate;        ///< how the clusters of a coarse cell are found
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< RefineMethod::Insert only
  RefineArea refine_area = RefineArea::Known;             ///< which cells can get clusters
  ErrorFactor error_factor = ErrorFactor::One;            ///< factor of eq. (6); also in OnlineStatistics::errors
  int threads = 0;                                        ///< 0 = all cores

  /// Returns the options of the paper, Yguel 2009, for `dimensions` = 2 or 3.
  ///
  /// - Cells: three scales, ratio 10, finest side 0.05 m in 2-D, 0.1 m in 3-D (sec. 6).
  /// - Learning: the rate depends on the occupancy, eq. (5), between 5e-4 and 5e-2, o_max = 10 (sec. 4.4, Algorithm 1).
  /// - Occupancy: the range image raises and lowers every cluster of every scale, by the mean over B random samples of
  ///   the cluster. B is that of eq. (1), with the range to the centre of the cell. Every scan in 2-D, every third scan
  ///   in 3-D (sec. 4.1, 6).
  /// - Deletion: clusters of low occupancy, without the other cells of their objects (sec. 5.3). Earlier scans are not
  ///   used.
  /// - Refinement: every 10 scans, the p = 4 visible cells of largest error of each scale get one cluster each, within
  ///   the budget. The error of eq. (6) has the factor 1 - eps. The new cluster starts as a copy of the Gaussian of
  ///   largest distortion (sec. 5.1, 6, Algorithm 2).
  ///
  /// The paper does not give the log-odds per hit and miss, the deletion threshold, the test whether a beam passes
  /// through a point, and the size of the budget. Here they have the defaults of this library. Where the paper leaves
  /// its method open, this library decides:
  /// - A new cluster starts at its first point, with the covariance of the noise floor and log-odds 0. Every covariance
  ///   that learns keeps the noise floor, so that it stays invertible.
  /// - B has no limit where the sensor is close to the centre of a cell. It is limited to the pixels of the image.
  /// - A cell is visible if it holds a point of the present scan.
  /// - p clusters per scale. No field of view per scale (sec. 3), because the paper gives none; see max_ranges.
  /// - A coarse cluster is deleted with its last child, whatever its own occupancy: the clustering that adjusts the
  ///   others leaves no cluster without members.
  /// - A cluster of a new partition inherits the occupancy of the old cluster with the largest part of its weight.
  /// - The loop of swaps ends after 20 rounds.
  ///
  /// Throws std::invalid_argument for any other value of `dimensions`.
  static OnlineOptions yguel2009(int dimensions);
};

/// A deleted cluster and the evidence for its deletion.
///
/// At the finest scale, this can be a part of a cluster: the points of an object in a cell that it shared with a
/// surface.
template <int D>
struct RemovedCluster {
  int scale = 0;           ///< scale of the cluster
  Gaussian<D> gaussian;    ///< map frame
  CellKey<D> key;          ///< cell of the cluster
  CellMoments<D> moments;  ///< exact moments for restore(); finest scale and LearningRate::SampleMean only
  double log_odds = 0.0;   ///< occupancy at the time of the deletion
  Evidence evidence;       ///< hits and misses
  std::uint32_t scan = 0;  ///< number of the last scan before the deletion, from 0
};

/// Reports the work of one call of OnlineMapper::add().
struct OnlineStatistics {
  PointCounts points;             ///< accepted and dropped points of the scan
  std::size_t cells_touched = 0;  ///< finest cells with points of the scan
  std::size_t cells_new = 0;      ///< touched cells that were not occupied before
  std::size_t cells_tested = 0;   ///< coarse cells tested for whether beams can have passed through any part of them
  std::size_t cells_visited = 0;  ///< finest cells in coarse cells that passed this test
  std::size_t deleted = 0;        ///< deleted clusters of all scales, including parts of clusters
  std::size_t added = 0;          ///< clusters added by the refinement
  std::vector<double> errors;     ///< per scale: mean error, eq. (6), of the touched cells; empty if not refined now
  double update_time = 0.0,       ///< duration of the update by points [s]
      image_time = 0.0,           ///< duration of making the range image [s]
      look_back_time = 0.0,       ///< duration of testing new cells against earlier range images [s]
      occupancy_time = 0.0,       ///< duration of the occupancy update [s]
      forget_time = 0.0,          ///< duration of the deletion [s]
      refine_time = 0.0;          ///< duration of the refinement [s]
};

/// Builds a map scan by scan, Yguel 2009 sec. 3 to 5.
///
/// Points move their clusters. Range images show which clusters are still there and which are gone. Coarse cells get
/// more clusters where they need them. The memory grows with the map, not with the number of scans.
template <int D>
class GAUSSMAP_API OnlineMapper {
 public:
  /// A function that receives a deleted cluster.
  using Removed = std::function<void(const RemovedCluster<D>&)>;

  /// Makes an empty map. `removed` is called for every deleted cluster. Throws std::invalid_argument if an option is
  /// out of range; the message names the option.
  explicit OnlineMapper(const OnlineOptions& options = {}, Removed removed = {});
  ~OnlineMapper();
  OnlineMapper(OnlineMapper&&) noexcept;
  OnlineMapper& operator=(OnlineMapper&&) noexcept;

  /// Adds one scan to the map. Only returns within the range limits and the box are used.
  ///
  /// For D = 2, points are transformed to the map frame and lose their z coordinate. The z axis of the sensor must
  /// therefore be parallel to that of the map, which is not checked. Throws std::out_of_range if a point lies beyond
  /// the range of 32-bit cell indices (the message gives the point). The map is then unchanged, and the scan is not
  /// counted.
  OnlineStatistics add(Scan scan);

  /// Puts a deleted cluster of the finest scale back, with the maximum log-odds: the caller knows that it is still
  /// there. Throws std::invalid_argument for a cluster of another scale.
  void restore(const RemovedCluster<D>& removed);

  /// Returns a copy of the current map. With LearningRate::SampleMean the finest scale holds exact moments, and every
  /// coarse cluster is the moment match of its children.
  GaussianMap<D> map() const;
  /// Returns the number of scans added.
  std::size_t scans() const;
  /// Returns the options, with all lengths set. If map.noise was 0, it is replaced by its automatic value (resolution /
  /// 20).
  const OnlineOptions& options() const;
  /// Returns the approximate number of bytes in use.
  std::size_t memoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
