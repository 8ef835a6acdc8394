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
/// The error is the distance of samples of this scale from samples of the finest scale [m]. The samples of the finest
/// scale are as dense as the points were. Errors below about half the side of a finest cell are therefore not
/// meaningful.
struct ErrorPoint {
  std::size_t gaussians = 0;  ///< number of Gaussians of the scale
  double q99 = 0.0;           ///< 99 % of the distances are at most this long [m]
  double q95 = 0.0;           ///< 95 % of the distances are at most this long [m]
  double mean = 0.0;          ///< mean distance [m]
};

/// The errors that other budgets would give at one scale.
struct ErrorCurve {
  int scale = 1;                   ///< the scale
  std::vector<ErrorPoint> points;  ///< by increasing number of Gaussians; the first point is one Gaussian per cell
};

/// The samples from which errors are measured.
struct ErrorSampling {
  std::size_t samples = 20000;  ///< samples of the measured scale, distributed by volume, >= 1
  std::size_t data = 200000;    ///< samples of the finest scale, distributed by weight, >= 1
  std::uint64_t seed = 1;       ///< of both
};

/// Selects the points of the error curves.
struct CurveOptions {
  std::vector<double> multiples = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< Gaussians per cell, increasing, each >= 1
  ErrorSampling sampling;  ///< replaced by the sampling of the budget if that is MaxError
};

/// A scale that cannot reach the error of MaxError.
struct NotReached {
  int scale = 1;     ///< the scale
  double q95 = 0.0;  ///< refine(): smallest error that the finer scale allows; simplify(): error of the scale [m]
};

/// The result of refine() and simplify().
template <int D>
struct RefineResult {
  GaussianMap<D> map;                   ///< the new map
  std::vector<ErrorCurve> curves;       ///< of scales 1, 2, ...; empty unless RefineOptions::curves is set
  std::vector<NotReached> not_reached;  ///< MaxError only
};

/// A budget: the maximum number of Gaussians per scale, as a multiple of its occupied cells.
struct PerCell {
  double gaussians = 3.0;  ///< >= 1; 1: one per cell
};

/// A budget: the maximum number of Gaussians per scale. For scales that are not listed, refine() uses `PerCell{}`;
/// simplify() does not change them.
struct MaxGaussians {
  std::map<int, std::size_t> by_scale;  ///< per scale; at least the number of cells of the scale
};

/// A budget: the largest multiple of the occupied cells for which the map does not exceed a number of bytes. The
/// multiple is found to within 2 %. D = 3 only.
struct MaxBytes {
  std::uintmax_t bytes = 0;  ///< maximum size of the result
  /// Measures a result, for example maxFileBytes() the size of its map file. Required. While refine() searches the
  /// multiple, it passes placeholder curves whose text is at least as long as that of the final curves.
  std::function<std::uintmax_t(const RefineResult<3>&)> size_of;
};

/// A budget: the smallest number of Gaussians per scale for which ErrorPoint::q95 does not exceed a distance. D = 3
/// only.
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
  std::optional<CurveOptions> curves;        ///< measures the error of other budgets; D = 3 only
  // Insert only:
  int queue = 0;       ///< p, number of cells refined at a time, >= 1; 0: cells / 250, at least 4
  int max_swaps = 20;  ///< maximum rounds of the swap loop per inserted cluster, >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;  ///< centre of a new cluster
  std::uint64_t seed = 0;                                 ///< same map + same seed = bit-identical result
  // Both:
  int threads = 0;  ///< 0 = all cores

  /// Returns the options of the paper, Yguel 2009.
  ///
  /// Clusters are inserted (sec. 5.2), in the p = 4 cells of largest error, eq. (6), at a time. Each new cluster starts
  /// as a copy of the Gaussian of largest distortion, with its own covariance (Algorithm 2, lines 5, 18 and 21).
  /// The default options differ because they give better maps: agglomeration instead of insertion. For insertion, the
  /// defaults refine more cells at a time, which keeps all threads busy. A new cluster then starts with the covariance
  /// of the cluster that the Gaussian leaves.
  static RefineOptions yguel2009();
};

/// Gives the coarse scales more Gaussians where one Gaussian per cell represents the finer ones badly.
///
/// The result depends on the finest scale only, which does not change. From fine to coarse, every coarse scale is
/// rebuilt and gets the number of Gaussians that the budget allows, but at most one per finer Gaussian. The map is
/// moved, not copied: `refine(std::move(map))` needs no memory for a second finest scale.
///
/// RefineMethod::Agglomerate: agglomerate() merges the finer Gaussians below a cell into a dendrogram. Before, their
/// covariances are enlarged by the square of half the side of a finest cell. Their areas are the numbers of occupied
/// finest cells that they represent. From the top of all dendrograms of the scale, the most expensive merges are undone
/// until the budget is used. This method uses no random numbers.
///
/// RefineMethod::Insert, Yguel 2009 sec. 5: the p cells of largest error, eq. (6), get one more cluster each (see
/// insertCluster(), Algorithm 2) and return to the queue with their new error. This repeats until the budget is used.
/// A cell leaves the queue if it has one cluster per finer Gaussian, if its error is 0, or if the insertion yields no
/// additional cluster. The budget is then not fully used.
///
/// Every cluster is the moment match of its children, weighted by numbers of points. The total weight of a scale thus
/// stays the number of points.
///
/// Error curves, MaxBytes and MaxError need one dendrogram for all budgets: RefineMethod::Agglomerate and D = 3. The
/// curve of a scale is measured with the finer scale as refined. A scale that cannot reach MaxError gets one cluster
/// per finer Gaussian and is listed in RefineResult::not_reached.
///
/// Throws std::invalid_argument in these cases:
/// - A budget or an option is out of range; the message names it.
/// - The map is compressed.
/// - MaxBytes: one Gaussian per cell exceeds the limit; the message gives the bytes needed.
template <int D>
GAUSSMAP_API RefineResult<D> refine(GaussianMap<D> map, const Budget& budget = PerCell{},
                                    const RefineOptions& options = {});

}  // namespace gaussmap
