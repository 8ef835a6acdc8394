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
  /// the occupancy, and only that of clusters that the scan did not hit.
  Points,
  /// The range image decides, as in Yguel 2009 sec. 4.1: samples at the surface that the beams hit raise the occupancy,
  /// samples that the beams passed through lower it, and others change nothing. The log-odds of a cluster change by the
  /// mean over its samples. Each cluster of each scale is tested separately, so every cluster has an occupancy, and a
  /// learning rate, of its own.
  RangeImage
};

/// Which points of a cluster are tested against a range image.
enum class OccupancySamples {
  Mean,   ///< the mean of the cluster
  Random  ///< slower: B random samples, where B is the number of pixels that can see the cell, Yguel 2009 eq. (1)
};

/// The place whose distance from the sensor is delta in Yguel 2009 eq. (1). It determines the number of random samples.
enum class SampleRange {
  Mean,       ///< the mean of the cluster
  CellCentre  ///< the centre of the cell of the cluster, as in Yguel 2009
};

/// The factor of a finer cluster in the error of a coarse cell, Yguel 2009 eq. (6).
enum class ErrorFactor {
  One,          ///< all finer clusters count alike
  OneMinusRate  ///< 1 - eps, with the learning rate of eq. (5); LearningRate::Occupancy only
};

/// The coarse cells that can get clusters from a refinement.
enum class RefineArea {
  /// All cells of the map. The need of a cell for clusters is measured when a refinement follows a scan with points in
  /// the cell. Later refinements use this value until it is measured again.
  Known,
  /// Only cells with points of the current scan, Yguel 2009 sec. 5.1.
  Visible
};

/// Options of OnlineMapper.
struct GAUSSMAP_API OnlineOptions {
  MapOptions map;                                              ///< cells of the map
  double max_range = std::numeric_limits<double>::infinity();  ///< points farther from the sensor are ignored [m]
  double min_range = 0.0;  ///< points nearer to the sensor are ignored, but hide what is behind them [m]
  /// Points outside this box are ignored [m, map frame]. Their beams are still used for the occupancy.
  std::optional<Box<3>> crop = std::nullopt;
  LearningRate learning_rate = LearningRate::SampleMean;  ///< how far a point moves its cluster
  double slowest_rate = 5e-4;  ///< eps_min of eq. (5), LearningRate::Occupancy only, in (0, 1]
  double fastest_rate = 5e-2;  ///< eps_max of eq. (5), LearningRate::Occupancy only, in [slowest_rate, 1]

  OccupancyOptions occupancy;                         ///< log-odds per hit and per miss
  HitRule hit_rule = HitRule::Points;                 ///< what raises the occupancy of a cluster
  VisibilityOptions visibility;                       ///< when a beam passes through a cluster
  OccupancySamples samples = OccupancySamples::Mean;  ///< which points of a cluster are tested
  SampleRange sample_range = SampleRange::Mean;       ///< OccupancySamples::Random only: delta of eq. (1)
  /// Maximum number of random samples per cluster, >= 0. 0: the number of pixels of the range image is the only limit.
  /// Close to the sensor, B of eq. (1) grows without limit.
  int max_samples = 100;
  /// Projection of every scan. std::nullopt: it is determined from the points, again whenever a scan does not fit it.
  std::optional<Projection> projection;
  /// Pixels without return are free space up to this range [m]; std::nullopt: they show nothing.
  std::optional<double> no_return_is_free;
  std::vector<double> max_ranges;  ///< per scale: cells farther from the sensor are not tested [m]; empty: no limit
  int occupancy_every = 1;         ///< number of scans from one update of the occupancy to the next, >= 1
  /// Number of recent scans of which the mapper keeps data, >= 0. Their range images show whether beams have passed
  /// through a new cell before. Their moments per cell are used by `shared`, which needs at least 1.
  int look_back = 10;

  /// Deletes a finest cluster if a scan lowers its log-odds below `forget_below`. Also deletes the other cells of its
  /// object, and then the coarse clusters without children. The object consists of connected cells. All their hits lie
  /// between the first and the last hit of the deleted cluster.
  bool forget = true;
  double forget_below = 0.0;  ///< limit of the deletion [log-odds], between -max_log_odds and max_log_odds
  /// Cells of an object up to this far apart are connected [m]; adjacent cells always are. std::nullopt: the default of
  /// MovingCellOptions::link.
  std::optional<double> link = std::nullopt;
  /// Maximum distance of the other cells of an object from the cell below the limit [m]. std::nullopt: the default of
  /// MovingCellOptions::reach.
  std::optional<double> reach = std::nullopt;
  /// Options for cells beside a deleted object that also hold a surface (floor or wall). In such a cell, the points off
  /// the surface are deleted. Only points of the last look_back scans are deleted, and only if their scan can have seen
  /// the object. Needs `forget` and LearningRate::SampleMean.
  SharedCellOptions shared;

  /// Number of scans from one refinement of the coarse scales to the next; 0 = never. A coarse cell can get clusters
  /// only if the mean probability of occupancy of its finer clusters is above 0.5, Yguel 2009 sec. 5.1.
  int refine_every = 10;
  /// p, maximum number of clusters added per scale and refinement; 0: as many as the budget allows. With
  /// RefineMethod::Insert, a cell gets at most one per refinement. With p = 4, as in the paper, the coarse scales have
  /// only a third of the Gaussians of their budget after a drive of 20 scans.
  std::size_t refine_cells = 0;
  double budget = 3.0;  ///< maximum Gaussians of a coarse scale after a refinement, as a multiple of its cells, >= 1
  RefineMethod method = RefineMethod::Agglomerate;        ///< how the clusters of a coarse cell are found
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< RefineMethod::Insert only
  RefineArea refine_area = RefineArea::Known;             ///< which cells can get clusters
  ErrorFactor error_factor = ErrorFactor::One;            ///< for RefineMethod::Insert and OnlineStatistics::errors
  int threads = 0;                                        ///< 0 = all cores

  /// Returns the options of the paper, Yguel 2009, for `dimensions` = 2 or 3.
  ///
  /// - Cells: three scales, ratio 10, finest side 0.05 m in 2-D and 0.1 m in 3-D (sec. 6).
  /// - Learning: the rate depends on the occupancy, eq. (5), between 5e-4 and 5e-2, o_max = 10 (sec. 4.4, Algorithm 1).
  /// - Occupancy: the range image raises and lowers the log-odds of every visible cluster of every scale, by the mean
  ///   over B random samples of the cluster. B is that of eq. (1), with the range to the centre of the cell. The
  ///   occupancy is updated with every scan in 2-D and with every third scan in 3-D (sec. 4.1, 6).
  /// - Deletion: finest clusters of low occupancy, and coarse clusters without children (sec. 5.3). The other cells of
  ///   an object are not deleted with its freed cell. New cells are not tested against earlier scans.
  /// - Refinement: every 10 scans, the p = 4 visible cells of largest error of each scale get one cluster each, within
  ///   the budget. Cells that are probably free get none. The error of eq. (6) has the factor 1 - eps. The new cluster
  ///   starts as a copy of the Gaussian of largest distortion (sec. 5.1, 6, Algorithm 2).
  ///
  /// The paper does not give the log-odds per hit and miss, the deletion threshold and the size of the budget. Here
  /// they have the defaults of this library.
  ///
  /// One thing differs from the paper: it compares a sample with the range of one pixel (sec. 4.1). visibilityOf() uses
  /// the pixels around it, and the limits of `visibility`, which the paper does not give.
  ///
  /// Where the paper leaves its method open, this library decides:
  /// - A scan first moves the clusters and then changes their occupancy. The learning rates thus come from the
  ///   occupancy before the scan.
  /// - A new cluster starts at its first point, with the covariance of the noise floor and log-odds 0. Every covariance
  ///   that learns keeps the noise floor, so that it stays invertible.
  /// - Near the sensor, B grows without limit. Here the number of pixels of the image limits it.
  /// - Rejected samples are not replaced. If all samples lie outside the cell, the mean of the cluster is tested.
  /// - A cell is visible for the refinement if it holds a point of the current scan.
  /// - p is the number of clusters per scale, not of all scales together.
  /// - The scales have no separate fields of view (sec. 3), because the paper gives no values. max_ranges can set them
  ///   for the occupancy only; points are used at all ranges.
  /// - A coarse cluster is deleted with its last child, whatever its own occupancy is. The clustering that adjusts the
  ///   other clusters leaves no cluster without members.
  /// - After a clustering, a cluster inherits the occupancy of the old cluster with the largest part of its weight.
  /// - The swap loop ends after KLKMeansOptions::max_swaps rounds, and a run of k-means after
  ///   KLKMeansOptions::max_iterations.
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
  CellMoments<D> moments;  ///< exact moments for restore(); only for the finest scale with LearningRate::SampleMean
  double log_odds = 0.0;   ///< occupancy at the time of the deletion
  Evidence evidence;       ///< hits and misses
  std::uint32_t scan = 0;  ///< number of the scan that was added when the cluster was deleted, from 0
};

/// Reports the work of one call of OnlineMapper::add().
struct OnlineStatistics {
  PointCounts points;             ///< accepted and dropped points of the scan
  std::size_t cells_touched = 0;  ///< finest cells with points of the scan
  std::size_t cells_new = 0;      ///< touched cells that were not occupied before
  /// Coarse cells that were tested by culling: can beams have passed through a part of the cell? With
  /// HitRule::RangeImage: can beams have passed through a part of it or have ended there?
  std::size_t cells_tested = 0;
  std::size_t cells_visited = 0;  ///< finest cells in coarse cells for which the answer was yes
  std::size_t deleted = 0;        ///< deleted clusters of all scales, including parts of clusters
  /// Clusters that the refinement gave to cells. Clusters that it took from another cell count too, and so do
  /// insertions that did not yield an additional cluster.
  std::size_t added = 0;
  /// Per scale: mean error, Yguel 2009 eq. (6), of the cells with points of the scan, before the refinement; 0 for the
  /// finest scale. Empty if this scan was followed by no refinement.
  std::vector<double> errors;
  double update_time = 0.0,  ///< duration of the update by points [s]
      image_time = 0.0,      ///< duration of making the range image [s]
      look_back_time = 0.0,  ///< duration of testing new cells against earlier range images [s]
      occupancy_time = 0.0,  ///< duration of the occupancy update [s]
      forget_time = 0.0,     ///< duration of the deletion [s]
      refine_time = 0.0;     ///< duration of the refinement [s]
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
  /// there. If the map has a cluster in this cell again, both are merged, and the log-odds of that cluster stay. Throws
  /// std::invalid_argument for a cluster of another scale.
  void restore(const RemovedCluster<D>& removed);

  /// Returns a copy of the current map. With LearningRate::SampleMean the finest scale holds exact moments, and every
  /// coarse cluster is the moment match of its children.
  GaussianMap<D> map() const;
  /// Returns the number of scans added.
  std::size_t scans() const;
  /// Returns the options. Lengths that were std::nullopt have their defaults. If map.noise was 0, it is replaced by its
  /// automatic value (resolution / 20).
  const OnlineOptions& options() const;
  /// Returns the approximate number of bytes in use.
  std::size_t memoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
