// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/refine.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "map/areas.h"
#include "map/inherit_occupancy.h"
#include "refine_scale.h"

namespace gaussmap {
using namespace detail;

namespace {

void checkOptions(const RefineOptions& options, int scales) {
  require(std::isfinite(options.budget) && options.budget >= 1.0, "budget", options.budget,
          "must be at least 1 Gaussian per cell");
  for (const auto& limit : options.max_gaussians)
    require(limit.first >= 1 && limit.first < scales, "max_gaussians of scale", limit.first,
            "must be of a coarse scale, 1 to " + std::to_string(scales - 1));
  require(options.queue >= 0, "queue", options.queue, "must be at least 1 (0 = automatic)");
  require(options.max_swaps >= 0, "max_swaps", options.max_swaps, "must not be negative");
  require(options.threads >= 0, "threads", options.threads, "must be at least 1 (0 = all)");
}

/// Makes every coarse scale anew from the finer one and lets refineScale(scale, areas) refine it.
template <int D, typename RefineScale>
GaussianMap<D> refineScales(const GaussianMap<D>& map, const RefineScale& refineScale) {
  if (map.isCompressed())
    throw std::invalid_argument(
        "the map is compressed: its finest scale is incomplete, so that the coarse ones cannot be "
        "made anew; refine first, then compress");
  std::vector<MapScale<D>> scales = {map.scale(0)};
  std::vector<double> areas = finestAreas(scales.front());
  for (int finer_scale = 0; finer_scale + 1 < map.scales(); ++finer_scale) {
    MapScale<D>& finer = scales.back();
    MapScale<D> coarse = coarsen(finer, map.grid(), finer_scale);
    CoarseScale<D> scale{finer, coarse, map.grid(), finer_scale};
    refineScale(scale, areas);
    inheritOccupancy<D>(finer, coarse);
    areas = coarserAreas(finer, areas, coarse.gaussianCount());
    scales.push_back(std::move(coarse));
  }
  return GaussianMap<D>(map.options(), std::move(scales));
}

}  // namespace

template <int D>
GaussianMap<D> detail::refineByChoice(GaussianMap<D> map, const RefineOptions& options,
                                      const std::function<std::size_t(const ScaleCuts<D>&)>& choose) {
  checkOptions(options, map.scales());
  if (map.empty() || map.scales() == 1) return map;
  return refineScales<D>(map, [&](CoarseScale<D>& scale, const std::vector<double>& areas) {
    const ScaleCuts<D> cuts(scale, areas, options);
    const std::size_t extra = choose(cuts);
    if (extra > 0) scale.replaceGaussians(cuts.clusters(extra));
  });
}

template <int D>
GaussianMap<D> refine(GaussianMap<D> map, const RefineOptions& options) {
  checkOptions(options, map.scales());
  if (map.empty() || map.scales() == 1) return map;
  return refineScales<D>(map, [&](CoarseScale<D>& scale, const std::vector<double>& areas) {
    const std::size_t extra = scale.extraAllowed(options);
    if (options.method == RefineMethod::Insert)
      refineByInsertion(scale, options);
    else if (extra > 0)
      scale.replaceGaussians(ScaleCuts<D>(scale, areas, options).clusters(extra));
  });
}

template GaussianMap<2> refine<2>(GaussianMap<2>, const RefineOptions&);
template GaussianMap<3> refine<3>(GaussianMap<3>, const RefineOptions&);
template GaussianMap<3> detail::refineByChoice<3>(GaussianMap<3>, const RefineOptions&,
                                                  const std::function<std::size_t(const ScaleCuts<3>&)>&);

}  // namespace gaussmap
