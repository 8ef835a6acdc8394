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

/// How far samples of a scale lie from the data if it has so many Gaussians [m]. The data are samples of the finest
/// scale, as dense as its points were: errors below about half a finest cell mean nothing.
struct ErrorPoint {
  std::size_t gaussians = 0;
  double q99 = 0.0;
  double q95 = 0.0;
  double mean = 0.0;
};

/// What other budgets would give at one scale.
struct ErrorCurve {
  int scale = 1;
  std::vector<ErrorPoint> points;  ///< at rising numbers of Gaussians; the first is one per cell
};

/// From which samples errors are measured.
struct ErrorSampling {
  std::size_t samples = 20000;  ///< of a scale, by volume, >= 1
  std::size_t data = 200000;    ///< of the finest scale, by weight, >= 1
  std::uint64_t seed = 1;
};

/// Which points of the error curves are measured.
struct CurveOptions {
  std::vector<double> multiples = {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0};  ///< of the scale's cells, rising, >= 1
  ErrorSampling sampling;  ///< with MaxError, its sampling is used for the curves too
};

/// A scale that cannot be brought below the error of MaxError.
struct NotReached {
  int scale = 1;
  double q95 = 0.0;  ///< the least that the finer scale's Gaussians allow; simplify(): the error that it has [m]
};

/// What refine() and simplify() return.
template <int D>
struct RefineResult {
  GaussianMap<D> map;
  std::vector<ErrorCurve> curves;       ///< scales 1, 2, ... if RefineOptions::curves asks for them
  std::vector<NotReached> not_reached;  ///< MaxError only
};

/// At most so many Gaussians per scale, as a multiple of its occupied cells.
struct PerCell {
  double gaussians = 3.0;  ///< >= 1; 1: one per cell
};

/// At most so many Gaussians per scale. For scales that are not listed, refine() uses PerCell{}; simplify() leaves them
/// as they are.
struct MaxGaussians {
  std::map<int, std::size_t> by_scale;  ///< not less than the scale has cells
};

/// The largest multiple of the occupied cells whose map is not larger than a number of bytes, to 2 %. D = 3 only.
struct MaxBytes {
  std::uintmax_t bytes = 0;
  /// Measures a result, for example maxFileBytes() the size of its map file. Required. While refine()
  /// searches the budget, it passes curves whose text is at least as long as that of the final ones.
  std::function<std::uintmax_t(const RefineResult<3>&)> size_of;
};

/// As few Gaussians per scale as keep the 95 % quantile of ErrorPoint at this distance or below. D = 3 only.
struct MaxError {
  double metres = 0.0;  ///< > 0 [m]
  ErrorSampling sampling;
};

/// The limit of a refinement or simplification.
using Budget = std::variant<PerCell, MaxGaussians, MaxBytes, MaxError>;

enum class RefineMethod {
  Agglomerate,  ///< bottom-up: from all finer Gaussians, merged where it costs least (agglomerate())
  Insert,  ///< top-down, as in the paper: from one Gaussian per cell, one more where the error is (insertCluster())
};

struct GAUSSMAP_API RefineOptions {
  RefineMethod method = RefineMethod::Agglomerate;
  // Agglomerate only:
  MergeCost merge_cost = MergeCost::Volume;
  std::optional<CurveOptions> curves;  ///< measure what other budgets would give; D = 3 only
  // Insert only:
  int queue = 0;       ///< p, cells refined at a time, >= 1; 0: cells / 250, at least 4
  int max_swaps = 20;  ///< limit of the rounds of the swap loop per inserted cluster, >= 0
  ClusterSeed seed_rule = ClusterSeed::ParentCovariance;
  std::uint64_t seed = 0;  ///< same map + same seed = same bytes, at any number of threads
  // Both:
  int threads = 0;  ///< 0 = all cores

  /// The paper as printed (Yguel 2009): clusters are inserted (sec. 5.2), into the p = 4 cells of largest error (eq.
  /// (6)) at a time, and each new cluster starts at the datum of largest distortion with that datum's own covariance
  /// (Algorithm 2, lines 5, 18 and 21). The defaults differ where that gives better maps: agglomeration instead of
  /// insertion; for insertion larger rounds, which keep all threads busy, and the covariance of the cluster that the
  /// datum leaves.
  static RefineOptions yguel2009();
};

/// Gives the coarse scales more Gaussians where one per cell represents the finer ones badly. The result depends on the
/// finest scale only: from the finest to the coarsest, every coarse scale is rebuilt and gets as many Gaussians as the
/// budget allows (one per finer Gaussian at most). The finest scale does not change. The map is moved, not copied:
/// refine(std::move(map)) needs no second finest scale.
///
/// Agglomerate: the finer Gaussians z_j under a cell, blurred by half a finest cell, weighted by the number of occupied
/// finest cells that they represent, are merged to a dendrogram (agglomerate()). From the top of all dendrograms of the
/// scale, the merges that cost most are undone, until the budget is used. No random numbers.
///
/// Insert, Yguel 2009 sec. 5: as long as the budget lasts, the p cells of largest error (eq. (6)) get one more cluster
/// each (insertCluster(), Algorithm 2) and return to the queue with their new error. A cell leaves the queue when it
/// has a cluster for every finer Gaussian, its error is 0, or its data allow no more clusters; then less than the
/// budget is used.
///
/// Every cluster is the moment match (weights = numbers of points) of the finer Gaussians whose `parent` it is, so that
/// the total weight of a scale stays the number of points.
///
/// Error curves, MaxBytes and MaxError need one dendrogram for all budgets: agglomeration, and D = 3. The curve of a
/// scale is measured over the finer scale as it was refined. A scale that does not reach MaxError gets as many
/// Gaussians as the finer one and is listed in `not_reached`. Throws std::invalid_argument, naming the option, for a
/// budget or an option out of range, for MaxBytes that one Gaussian per cell exceeds (naming the bytes that it takes),
/// and for a compressed map.
template <int D>
GAUSSMAP_API RefineResult<D> refine(GaussianMap<D> map, const Budget& budget = PerCell{},
                                    const RefineOptions& options = {});

}  // namespace gaussmap
