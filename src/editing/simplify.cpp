// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/simplify.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/check.h"
#include "core/in_space.h"
#include "core/quantile.h"
#include "gaussmap/map/sampling.h"
#include "map/occupied_areas.h"
#include "mapping/budget.h"
#include "mapping/scale_clusters.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kAsManyAsNow = std::numeric_limits<double>::max();  // finite: 0 cells times this is 0, not NaN

/// Simplifies a map to a budget of PerCell or MaxGaussians.
template <int D>
GaussianMap<D> simplifyByCount(GaussianMap<D> map, const Budget& budget, const SimplifyOptions& options) {
  if (map.empty()) return map;
  const Grid<D> grid = map.grid();
  std::vector<MapScale<D>> scales = std::move(map).takeScales();
  std::vector<double> areas, finer_areas;
  bool changed = false;
  for (int s = 0; s < grid.scales(); ++s) {
    MapScale<D>& scale = scales[static_cast<std::size_t>(s)];
    MapScale<D>* const finer = s > 0 ? &scales[static_cast<std::size_t>(s) - 1] : nullptr;
    if (changed) matchClusters<D>(*finer, scale, grid, s);
    finer_areas = std::exchange(areas, {});
    areas = s > 0 ? areasOf<D>(scale, grid, s, *finer, finer_areas) : finestAreas<D>(scale);
    const std::size_t extra = extraGaussians(budget, s, scale.keys.size(), scale.gaussianCount(), kAsManyAsNow);
    if (scale.keys.size() + extra >= scale.gaussianCount()) continue;
    ClusterCut cut = ScaleClusters::within(scale, grid, s, areas, options.merge_cost, options.threads).cut(extra);
    if (options.smooth) cut = smoothed<D>(scale, grid, s, cut, options.threads);
    mergeClusters<D>(scale, finer, grid, s, cut);
    if (finer != nullptr) matchClusters<D>(*finer, scale, grid, s);
    areas = mergedAreas(areas, cut);
    changed = true;
  }
  return GaussianMap<D>(grid.options(), std::move(scales));
}

/// Returns the error of a scale: 95 % of its samples are at most this far from the nearest point of `data` [m].
template <int D>
double errorOf(const GaussianMap<D>& map, int s, const std::vector<Vector<3>>& data, const ErrorSampling& sampling,
               int threads) {
  const SampleOptions options{sampling.samples, 1, SampleShare::Volume, sampling.seed, threads};
  std::vector<double> distances = nearestDistances(inSpace(sampleMap<D>(map, s, options).points), data, threads);
  return percentile(distances, 95);
}

template <int D>
RefineResult<D> simplifyToError(GaussianMap<D> map, const MaxError& budget, const SimplifyOptions& options) {
  if (map.empty()) return {std::move(map), {}, {}};
  const ErrorSampling& sampling = budget.sampling;
  const SampleOptions data_options{sampling.data, 1, SampleShare::Mass, sampling.seed, options.threads};
  const std::vector<Vector<3>> data = inSpace(sampleLeaves<D>(map, data_options).points);
  RefineResult<D> result{std::move(map), {}, {}};
  for (int s = 0; s < result.map.scales(); ++s) {
    const GaussianMap<D>& before = result.map;
    if (before.gaussianCount(s) == before.cellCount(s)) continue;  // nothing to merge
    const auto error = [&](const GaussianMap<D>& trial) { return errorOf(trial, s, data, sampling, options.threads); };
    const double least = error(before);
    if (least > budget.metres) {
      result.not_reached.push_back({s, least});
      continue;
    }
    std::size_t low = before.cellCount(s) - 1, high = before.gaussianCount(s);  // too few Gaussians, and enough
    GaussianMap<D> best = before;
    while (high - low > 1 + high / 200) {  // to half a percent
      const std::size_t middle = low + (high - low) / 2;
      GaussianMap<D> trial = simplifyByCount<D>(before, MaxGaussians{{{s, middle}}}, options);
      const bool is_good = error(trial) <= budget.metres;
      if (is_good) best = std::move(trial);
      (is_good ? high : low) = middle;
    }
    result.map = std::move(best);
  }
  return result;
}

template <int D>
RefineResult<D> simplifyToBytes(GaussianMap<D> map, const MaxBytes& budget, const SimplifyOptions& options) {
  RefineResult<D> whole{std::move(map), {}, {}};
  if (sizeOf(budget, whole) <= budget.bytes) return whole;
  double most = 1.0;
  for (int s = 0; s < whole.map.scales(); ++s)
    most = std::max(most, double(whole.map.gaussianCount(s)) / std::max(1.0, double(whole.map.cellCount(s))));
  RefineResult<D> best;
  largestMultiple(most, budget.bytes, [&](double multiple) {
    RefineResult<D> trial{simplifyByCount<D>(whole.map, PerCell{multiple}, options), {}, {}};
    const std::uintmax_t bytes = sizeOf(budget, trial);
    if (multiple == 1.0) requireRoom(budget.bytes, bytes);
    if (bytes <= budget.bytes) best = std::move(trial);
    return bytes;
  });
  return best;
}

}  // namespace

SimplifyOptions SimplifyOptions::yguel2009() {
  SimplifyOptions options;
  options.merge_cost = MergeCost::KL;
  options.smooth = true;
  return options;
}

template <int D>
RefineResult<D> simplify(GaussianMap<D> map, const Budget& budget, const SimplifyOptions& options) {
  checkBudget(budget, 0, map.scales(), D);
  if (options.threads < 0)
    throw std::invalid_argument("threads = " + std::to_string(options.threads) +
                                ": must be at least 1 (0 = all cores)");
  if (const auto* bytes = std::get_if<MaxBytes>(&budget)) return simplifyToBytes(std::move(map), *bytes, options);
  if (const auto* error = std::get_if<MaxError>(&budget)) return simplifyToError(std::move(map), *error, options);
  return {simplifyByCount(std::move(map), budget, options), {}, {}};
}

template RefineResult<2> simplify<2>(GaussianMap<2>, const Budget&, const SimplifyOptions&);
template RefineResult<3> simplify<3>(GaussianMap<3>, const Budget&, const SimplifyOptions&);

}  // namespace gaussmap
