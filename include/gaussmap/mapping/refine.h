// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The error of a scale that has a certain number of Gaussians.
///
/// Both this scale and the finest scale are sampled (simplify(): the leaves instead of the finest scale). The error is
/// the distance from each sample of this scale to the nearest sample of the finest scale [m]. The samples of the finest
/// scale are as dense as the points were. Errors below about half the side of a finest cell are therefore not
/// meaningful.
struct ErrorPoint {
  std::size_t gaussians = 0;  ///< number of Gaussians of the scale
  double q99 = 0.0;           ///< 99 % of the distances are at most this long [m]
  double q95 = 0.0;           ///< 95 % of the distances are at most this long [m]
  double mean = 0.0;          ///< mean distance [m]
};

/// The errors of one scale with different numbers of Gaussians.
struct ErrorCurve {
  int scale = 1;                   ///< the scale
  std::vector<ErrorPoint> points;  ///< by increasing number of Gaussians; the first point is one Gaussian per cell
};

/// The samples from which errors are measured.
struct ErrorSampling {
  std::size_t samples = 20000;  ///< number of samples of the measured scale, see SampleShare::Volume, >= 1
  std::size_t data = 200000;    ///< number of samples of the finest scale, see SampleShare::Mass, >= 1
  std::uint64_t seed = 1;       ///< seed of both kinds of samples
};

/// Selects the points of the error curves.
struct CurveOptions {
  std::vector<double> multiples = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< Gaussians per cell, increasing, each >= 1
  ErrorSampling sampling;  ///< not used with the budget MaxError, which has its own
};

/// A scale that cannot reach the error of MaxError.
struct NotReached {
  int scale = 1;  ///< the scale
  /// ErrorPoint::q95 of the scale [m]. refine(): with one cluster per finer Gaussian, which is the maximum. simplify():
  /// before any merge.
  double q95 = 0.0;
};

/// The result of refine() and simplify().
template <int D>
struct RefineResult {
  GaussianMap<D> map;                   ///< the new map
  std::vector<ErrorCurve> curves;       ///< one per scale 1, 2, ...; empty unless RefineOptions::curves is set
  std::vector<NotReached> not_reached;  ///< scales that cannot reach the error; empty unless the budget is MaxError
};

/// A budget: the maximum number of Gaussians per scale, as a multiple of its occupied cells.
struct PerCell {
  double gaussians = 3.0;  ///< maximum mean number of Gaussians per occupied cell, >= 1
};

/// A budget: the maximum number of Gaussians per scale. For scales that are not listed, refine() uses `PerCell{}`;
/// simplify() does not change them.
struct MaxGaussians {
  std::map<int, std::size_t> by_scale;  ///< maximum by scale; each at least the number of occupied cells of its scale
};

/// A budget: the maximum size of the map in bytes. As with PerCell, the number of Gaussians per scale is a multiple of
/// its occupied cells. The multiple is the largest one that keeps the limit, to within 2 %.
struct MaxBytes {
  std::uintmax_t bytes = 0;  ///< maximum size of the result
  /// A function that returns the size of a result [bytes]. It must be set; for example, maxFileBytes() returns the size
  /// of the map file. While refine() searches for the multiple, RefineResult::curves holds placeholders, because
  /// measuring takes long. In a map file, their text is at least as long as that of the final curves.
  std::function<std::uintmax_t(const RefineResult<3>&)> size_of;
  /// The same for planar maps. A budget needs only the function for the dimension of the map.
  std::function<std::uintmax_t(const RefineResult<2>&)> planar_size_of = {};
};

/// A budget: the maximum error. Each scale gets the smallest number of Gaussians for which ErrorPoint::q95 does not
/// exceed a distance, to within 0.5 % of this number.
struct MaxError {
  double metres = 0.0;     ///< maximum of ErrorPoint::q95 [m], > 0
  ErrorSampling sampling;  ///< the samples from which the error is measured
};

/// The limit of a refinement or simplification.
using Budget = std::variant<PerCell, MaxGaussians, MaxBytes, MaxError>;

/// How the clusters of a coarse cell are found.
enum class RefineMethod {
  /// Agglomeration, bottom-up: starts from all finer Gaussians and merges the cheapest pairs, see agglomerate().
  Agglomerate,
  /// Insertion, top-down, as in the paper: starts from one Gaussian per cell and adds clusters where the error is
  /// largest, see insertCluster().
  Insert,
};

/// Options of refine().
struct GAUSSMAP_API RefineOptions {
  RefineMethod method = RefineMethod::Agglomerate;  ///< how the clusters of a coarse cell are found
  // Agglomerate only:
  MergeCost merge_cost = MergeCost::Volume;  ///< which pair is merged next
  std::optional<CurveOptions> curves;        ///< measures the error of other budgets
  // Insert only:
  int queue = 0;       ///< p, number of cells refined at a time, >= 1; 0: 1/250 of the scale's cells, at least 4
  int max_swaps = 20;  ///< maximum number of rounds of the swap loop per inserted cluster (see insertCluster()), >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< how a new cluster starts
  GaussianDistance distance = GaussianDistance::KL;       ///< from a Gaussian to a cluster, see KLKMeans
  std::uint64_t seed = 0;                                 ///< same map + same seed = bit-identical result
  /// Adds clusters only to cells whose finer Gaussians have a mean probability of occupancy above 0.5, Yguel 2009 sec.
  /// 5.1. The probability of a Gaussian is 1 / (1 + exp(-log-odds)). Has no effect on maps without occupancy.
  bool only_occupied = false;
  /// Multiplies the terms of eq. (6) by 1 - eps, as in the paper, where eps is the learning rate of a finer Gaussian,
  /// eq. (5). The rate follows from its log-odds, with the constants of the paper: eps_min = 5e-4, eps_max = 5e-2 and
  /// o_max = 10. Has no effect on maps without occupancy.
  bool learning_factor = false;
  // Both:
  int threads = 0;  ///< 0 = all cores

  /// Returns the options of the paper, Yguel 2009.
  ///
  /// - The method is RefineMethod::Insert (sec. 5.2), with the KL divergence as distance.
  /// - In each round, the p = 4 cells of largest error, eq. (6), get one more cluster each (sec. 6).
  /// - A new cluster starts as a copy of the Gaussian of largest distortion (Algorithm 2, lines 5, 18 and 21).
  /// - If the map has occupancy, cells that are probably free get no more clusters (sec. 5.1), and eq. (6) has the
  ///   factor 1 - eps.
  ///
  /// Some things differ from the paper. It refines a map between scans, and only the cells that the sensor sees;
  /// OnlineOptions::yguel2009() does this. refine() repeats its rounds on the whole map until the budget is used. The
  /// paper gives no size of the budget. The swap loop ends after max_swaps rounds, and a run of k-means ends after
  /// KLKMeansOptions::max_iterations; the paper has no such limits.
  ///
  /// The default method is RefineMethod::Agglomerate, because it gives better maps. If only `method` is set to
  /// RefineMethod::Insert, three more options differ from the paper: `queue` (more cells per round, which keeps all
  /// threads busy), `seed_rule`, and the use of occupancy (`only_occupied`, `learning_factor`).
  static RefineOptions yguel2009();
};

/// Gives the coarse scales more Gaussians where one Gaussian per cell represents the finer ones badly.
///
/// The finest scale does not change. The result depends on this scale and its log-odds only. From fine to coarse, every
/// coarse scale is rebuilt. It gets the number of Gaussians that the budget allows, but at most one per Gaussian of the
/// finer scale. The map is moved, not copied: `refine(std::move(map))` needs no memory for a second finest scale.
///
/// RefineMethod::Agglomerate: agglomerate() makes one dendrogram per cell from the finer Gaussians below the cell. For
/// this, the square of half the side of a finest cell is added to their variances (not for MergeCost::KL). Their areas
/// are the numbers of occupied finest cells that they represent. At first, each cell has one cluster. Then the function
/// undoes the most expensive merges of all cells of the scale, from the top of the dendrograms, until the budget is
/// used. This method uses no random numbers.
///
/// RefineMethod::Insert, Yguel 2009 sec. 5: the p cells of largest error, eq. (6), get one more cluster each (see
/// insertCluster(), Algorithm 2) and return to the queue with their new error. This repeats until the budget is used.
/// A cell leaves the queue if it has one cluster per finer Gaussian, if its error is 0, or if the insertion yields no
/// additional cluster. With RefineOptions::only_occupied, free cells do not enter the queue. If the queue becomes
/// empty, the budget is not fully used.
///
/// Every cluster is the moment match of its children, weighted by numbers of points. The total weight of a scale thus
/// stays the number of points.
///
/// Error curves, MaxBytes and MaxError need RefineMethod::Agglomerate, because one dendrogram gives the clusters for
/// all budgets. The curve of a scale is measured after the finer scale has been refined. A scale that cannot reach
/// MaxError gets one cluster per finer Gaussian and is listed in RefineResult::not_reached.
///
/// Throws std::invalid_argument in these cases:
/// - A budget or an option is out of range; the message names it.
/// - The map is compressed.
/// - MaxBytes: one Gaussian per cell exceeds the limit; the message gives the bytes needed.
template <int D>
GAUSSMAP_API RefineResult<D> refine(GaussianMap<D> map, const Budget& budget = PerCell{},
                                    const RefineOptions& options = {});

/// How badly the Gaussians of a coarse scale represent the finer ones: Yguel 2009, eq. (6) and Fig. 5.
///
/// The values have no unit: they are squared numbers of standard deviations of the finer Gaussians. The values of
/// two cells can differ by a factor of 1000 and more. The factor 1 - eps of eq. (6) is 1 here, as in refine() without
/// RefineOptions::learning_factor.
struct CellErrors {
  /// One value per cell of the scale: the error of the cell, which is the mean contribution of the finer Gaussians
  /// below it. NaN for a cell without finer cells (see GaussianMap::isLeaf()).
  std::vector<double> cells;
  /// One value per Gaussian of the next finer scale: its contribution to the error of the cell above it. This is the
  /// squared Mahalanobis distance, by its own covariance, of the nearest Gaussian of that cell.
  std::vector<double> contributions;
};

/// Returns the errors of the cells of scale `scale` >= 1, and the contributions of the Gaussians of scale `scale` - 1.
///
/// `threads`: 0 = all cores. Throws std::out_of_range if the map does not have the scale or if it is the finest, and
/// std::domain_error if a finer covariance is not positive definite.
template <int D>
GAUSSMAP_API CellErrors cellErrors(const GaussianMap<D>& map, int scale, int threads = 0);

}  // namespace gaussmap
