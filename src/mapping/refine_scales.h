// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "gaussmap/mapping/refine.h"
#include "map/inherit_occupancy.h"
#include "map/occupied_areas.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {

/// Rebuilds every coarse scale from the finer one, and calls refineScale(pair, areas) to refine it. `areas` = number of
/// occupied finest cells per finer Gaussian. Returns maps without cells and maps of one scale unchanged.
/// Throws std::invalid_argument if the map is compressed.
template <int D, typename RefineScale>
GaussianMap<D> refineScales(GaussianMap<D> map, const RefineScale& refineScale) {
  if (map.empty() || map.scales() == 1) return map;
  if (map.isCompressed())
    throw std::invalid_argument(
        "the map is compressed: its finest scale is incomplete, so its coarse scales cannot be rebuilt; refine first, "
        "then compress");
  const Grid<D> grid = map.grid();
  std::vector<MapScale<D>> scales = std::move(map).takeScales();
  for (std::size_t s = 1; s < scales.size(); ++s) scales[s] = {};
  std::vector<double> areas = finestAreas(scales.front());
  for (int finer_scale = 0; finer_scale + 1 < grid.scales(); ++finer_scale) {
    MapScale<D>& finer = scales[static_cast<std::size_t>(finer_scale)];
    MapScale<D>& coarse = scales[static_cast<std::size_t>(finer_scale) + 1];
    coarse = coarsen(finer, grid, finer_scale);
    refineScale(ScalePair<D>{finer, coarse, grid, finer_scale}, areas);
    inheritOccupancy<D>(finer, coarse);
    areas = coarserAreas(finer, areas, coarse.gaussianCount());
  }
  return GaussianMap<D>(grid.options(), std::move(scales));
}

}  // namespace gaussmap::detail
