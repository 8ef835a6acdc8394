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

/// How much a point moves the cluster that it falls to.
enum class LearningRate {
  SampleMean,  ///< 1 / n: a cluster is the exact moments of its points, in any order
  Occupancy    ///< Yguel 2009 eq. (5): little where the map has been seen often, more where it is uncertain
};

/// Which points of a cluster are tested against a range image.
enum class OccupancySamples {
  Mean,   ///< its mean
  Random  ///< as many samples from it as pixels may see it, Yguel 2009 eq. (1): the same decisions, but slower
};

struct GAUSSMAP_API OnlineOptions {
  MapOptions map;
  double max_range = std::numeric_limits<double>::infinity();  ///< farther points are left out [m]
  LearningRate learning_rate = LearningRate::SampleMean;
  double slowest_rate = 5e-4;  ///< eps_min of eq. (5), LearningRate::Occupancy only, in (0, 1]
  double fastest_rate = 5e-2;  ///< eps_max, at least eps_min, in (0, 1]

  OccupancyOptions occupancy;
  VisibilityOptions visibility;
  OccupancySamples samples = OccupancySamples::Mean;
  std::optional<Projection> projection;     ///< of every scan; nullopt: found, and again when a scan looks different
  std::optional<double> no_return_is_free;  ///< pixels without return are free space up to this range [m]
  std::vector<double> max_ranges;  ///< per scale: cells farther from the sensor are not tested [m]; empty: no limit
  int occupancy_every = 1;         ///< scans, >= 1
  int look_back = 10;  ///< how many scans are kept: their range images, to test new cells, and their sums; >= 0

  bool forget = true;                        ///< delete clusters whose occupancy is below 0 ...
  double link = MovingCellOptions().link;    ///< ... and the rest of their objects: cells connected to them [m] ...
  double reach = MovingCellOptions().reach;  ///< ... up to this far away, seen only while they were [m]
  SharedCellOptions shared;  ///< SampleMean only: also what the last look_back scans saw of them beside a surface

  int refine_every = 10;         ///< scans; 0 = never
  std::size_t refine_cells = 0;  ///< p, most clusters added to a scale at a time; 0: as many as the budget allows (with
                                 ///< the paper's 4, a drive of 20 scans ends at a third of its budget)
  double budget = 3.0;  ///< most Gaussians of a coarse scale after a refinement, as a multiple of its cells, >= 1
  RefineMethod method = RefineMethod::Agglomerate;
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< RefineMethod::Insert only
  int threads = 0;                                        ///< 0 = all cores

  /// The system of Yguel 2009 as printed, for `dimensions` = 2 or 3; throws std::invalid_argument for another value.
  /// - cells: three scales, ratio 10, finest side 0.05 m in 2-D, 0.1 m in 3-D (sec. 6);
  /// - learning: the rate depends on the occupancy, eq. (5), between 5e-4 and 5e-2, o_max = 10 (sec. 4.4, Algorithm 1);
  /// - occupancy: B samples per cluster, eq. (1), for every scan in 2-D and every third in 3-D (sec. 4.1, 6);
  /// - deletion: clusters of low occupancy, and nothing beside them (sec. 5.3);
  /// - refinement: every 10 scans the p = 4 cells of largest error of each scale get one cluster each, inserted with
  /// the
  ///   datum itself as seed (sec. 5.1, 6, Algorithm 2), as long as the budget lasts.
  /// The paper prints no values for the hit and miss log-odds, the deletion threshold, when a beam passes through a
  /// point, and the size of the budget: these keep their defaults. Two parts differ from the print: the error of eq.
  /// (6) has no factor (1 - eps), and refinement may also choose a cell that an earlier scan touched.
  static OnlineOptions yguel2009(int dimensions);
};

/// A deleted cluster and why it was deleted. At the finest scale it may be a part of one: what an object left in a
/// cell that it shared with a surface.
template <int D>
struct RemovedCluster {
  int scale = 0;
  Gaussian<D> gaussian;  ///< map frame
  CellKey<D> key;
  CellMoments<D> moments;  ///< finest scale under LearningRate::SampleMean: exact, for restore()
  double log_odds = 0.0;
  Evidence evidence;
  std::uint32_t scan = 0;  ///< number of the scan that it was deleted after
};

/// What one add() did.
struct OnlineStatistics {
  PointCounts points;             ///< of the scan
  std::size_t cells_touched = 0;  ///< finest cells with points
  std::size_t cells_new = 0;      ///< of them, those not seen before
  std::size_t cells_tested = 0;   ///< of the coarser scales, what culling looked at
  std::size_t cells_visited = 0;  ///< of the finest scale, what it left to look at
  std::size_t deleted = 0;        ///< clusters, of all scales, and parts of clusters
  std::size_t added = 0;          ///< clusters, by refinement
  std::vector<double> errors;     ///< per scale, mean error [6] of the cells that refinement looked at; empty if none
  // Seconds.
  double update_time = 0.0, image_time = 0.0, look_back_time = 0.0, occupancy_time = 0.0, forget_time = 0.0,
         refine_time = 0.0;
};

/// Builds a map scan by scan, Yguel 2009 sections 3 to 5: points move the clusters that they fall to, range images say
/// what is there and what is gone, and coarse cells get more clusters where they need them. Memory grows with the
/// map, not with the scans.
template <int D>
class GAUSSMAP_API OnlineMapper {
 public:
  using Removed = std::function<void(const RemovedCluster<D>&)>;

  /// `removed` is told every deleted cluster. Throws std::invalid_argument, naming the option.
  explicit OnlineMapper(const OnlineOptions& options = {}, Removed removed = {});
  ~OnlineMapper();
  OnlineMapper(OnlineMapper&&) noexcept;
  OnlineMapper& operator=(OnlineMapper&&) noexcept;

  /// One scan. D = 2: the map is the plane z = 0 seen from above, the sensor stands upright. Points that are no
  /// returns are left out. Throws std::out_of_range, naming the point, if one is too far for 32-bit cells; the scan is
  /// then not counted.
  OnlineStatistics add(Scan scan);

  /// Brings a deleted finest cluster back, as certain as can be: whoever calls this knows that it is there. Throws
  /// std::invalid_argument for another scale.
  void restore(const RemovedCluster<D>& removed);

  /// The map as it is now. With LearningRate::SampleMean the finest scale holds exact moments, and every coarse
  /// cluster is the moment match of the finer ones linked to it.
  GaussianMap<D> map() const;
  std::size_t scans() const;
  const OnlineOptions& options() const;
  /// Bytes held, about.
  std::size_t memoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace gaussmap
