// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/simplify.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/quantile.h"
#include "gaussmap/map/sampling.h"
#include "map/areas.h"
#include "mapping/cluster_cuts.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

template <int D>
void check(const GaussianMap<D>& map, const SimplifyOptions& options) {
  if (options.budget)
    require(std::isfinite(*options.budget) && *options.budget >= 1.0, "budget", *options.budget,
            "must be at least 1 Gaussian per cell");
  require(options.threads >= 0, "threads", options.threads, "must be at least 1 (0 = all)");
  for (const auto& [scale, most] : options.max_gaussians) {
    require(scale >= 0 && scale < map.scales(), "max_gaussians of scale", scale,
            "must be one of the map, 0 to " + std::to_string(map.scales() - 1));
    if (most < map.cellCount(scale))
      throw std::invalid_argument("max_gaussians = " + std::to_string(most) + ": scale " + std::to_string(scale) +
                                  " has " + std::to_string(map.cellCount(scale)) +
                                  " occupied cells, which hold at least one each");
  }
}

/// How many Gaussians beyond one a cell a scale may keep.
std::size_t extraAllowed(const SimplifyOptions& options, int s, std::size_t cells, std::size_t gaussians) {
  const auto most = options.max_gaussians.find(s);
  if (most != options.max_gaussians.end()) return most->second - cells;
  if (!options.budget) return gaussians - cells;
  const double allowed = std::floor(*options.budget * static_cast<double>(cells));
  return static_cast<std::size_t>(std::min(allowed, static_cast<double>(gaussians))) - cells;
}

/// How far samples of a scale are from some data: what 95 % of them do not exceed [m].
double errorOf(const GaussianMap<3>& map, int s, const std::vector<Vector<3>>& data, const CurveOptions& measure,
               int threads) {
  const SampleOptions sampling{measure.samples, 1, SampleShare::Volume, measure.seed, threads};
  std::vector<double> distances = nearestDistances(sampleMap<3>(map, s, sampling).points, data, threads);
  return percentile(distances, 95);
}

SimplifyOptions withLimit(SimplifyOptions options, int s, std::size_t gaussians) {
  options.budget.reset();
  options.max_gaussians = {{s, gaussians}};
  return options;
}

}  // namespace

template <int D>
GaussianMap<D> simplify(GaussianMap<D> map, const SimplifyOptions& options) {
  check(map, options);
  std::vector<MapScale<D>> scales;
  scales.reserve(std::size_t(map.scales()));
  for (int s = 0; s < map.scales(); ++s) scales.push_back(map.scale(s));
  std::vector<double> areas, finer_areas;
  bool changed = false;
  for (int s = 0; s < map.scales(); ++s) {
    MapScale<D>& scale = scales[static_cast<std::size_t>(s)];
    MapScale<D>* const finer = s > 0 ? &scales[static_cast<std::size_t>(s) - 1] : nullptr;
    if (changed) matchClusters<D>(*finer, scale, map.grid(), s);
    finer_areas = std::exchange(areas, {});
    areas = s > 0 ? areasOf<D>(scale, map.grid(), s, *finer, finer_areas) : finestAreas<D>(scale);
    const std::size_t extra = extraAllowed(options, s, scale.keys.size(), scale.gaussianCount());
    if (scale.keys.size() + extra >= scale.gaussianCount()) continue;
    const ClusterCuts<D> cuts(scale, map.grid(), s, areas, options.merge_cost, options.threads);
    const ClusterCut cut = cuts.withExtra(extra);
    mergeClusters<D>(scale, finer, map.grid(), s, cut);
    if (finer != nullptr) matchClusters<D>(*finer, scale, map.grid(), s);
    areas = mergedAreas(areas, cut);
    changed = true;
  }
  return changed ? GaussianMap<D>(map.options(), std::move(scales)) : map;
}

SimplifiedToError simplifyToError(GaussianMap<3> map, double max_error, const SimplifyOptions& options,
                                  const CurveOptions& measure) {
  require(std::isfinite(max_error) && max_error > 0.0, "max_error", max_error, "must be a positive number of metres");
  if (map.empty()) return {std::move(map), {}};
  const SampleOptions sampling{measure.data, 1, SampleShare::Mass, measure.seed, options.threads};
  const std::vector<Vector<3>> data = sampleLeaves<3>(map, sampling).points;
  std::vector<ErrorNotReached> not_reached;
  for (int s = 0; s < map.scales(); ++s) {
    if (map.gaussianCount(s) == map.cellCount(s)) continue;  // nothing to merge
    const auto error = [&](const GaussianMap<3>& trial) { return errorOf(trial, s, data, measure, options.threads); };
    const double least = error(map);
    if (least > max_error) {
      not_reached.push_back({s, least});
      continue;
    }
    std::size_t low = map.cellCount(s) - 1, high = map.gaussianCount(s);  // too few, and enough
    GaussianMap<3> best = map;
    while (high - low > 1 + high / 200) {  // to half a percent
      const std::size_t middle = low + (high - low) / 2;
      GaussianMap<3> trial = simplify<3>(map, withLimit(options, s, middle));
      const bool is_good = error(trial) <= max_error;
      if (is_good) best = std::move(trial);
      (is_good ? high : low) = middle;
    }
    map = std::move(best);
  }
  return {std::move(map), std::move(not_reached)};
}

GaussianMap<3> simplifyToBytes(const GaussianMap<3>& map, std::uintmax_t max_bytes,
                               const std::function<std::uintmax_t(const GaussianMap<3>&)>& bytesOf,
                               const SimplifyOptions& options) {
  constexpr double kPrecision = 1.02;  // of the budget
  if (bytesOf(map) <= max_bytes) return map;
  const auto within = [&](double budget) {
    SimplifyOptions changed = options;
    changed.budget = budget;
    changed.max_gaussians.clear();
    return simplify<3>(map, changed);
  };
  GaussianMap<3> best = within(1.0);
  const std::uintmax_t least = bytesOf(best);
  if (least > max_bytes)
    throw std::invalid_argument("max_bytes = " + std::to_string(max_bytes) + ": one Gaussian per cell takes " +
                                std::to_string(least) + " bytes already; take coarser cells, or gaussmap compress");
  double fits = 1.0, too_large = 1.0;
  for (int s = 0; s < map.scales(); ++s)
    too_large = std::max(too_large, double(map.gaussianCount(s)) / std::max(1.0, double(map.cellCount(s))));
  while (too_large > fits * kPrecision) {
    const double middle = 0.5 * (fits + too_large);
    GaussianMap<3> trial = within(middle);
    const bool is_good = bytesOf(trial) <= max_bytes;
    if (is_good) best = std::move(trial);
    (is_good ? fits : too_large) = middle;
  }
  return best;
}

template GaussianMap<2> simplify<2>(GaussianMap<2>, const SimplifyOptions&);
template GaussianMap<3> simplify<3>(GaussianMap<3>, const SimplifyOptions&);

}  // namespace gaussmap
