// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/build.h"

#include <stdexcept>

#include "core/check.h"
#include "map/coarsen.h"

namespace gaussmap {
using namespace detail;

namespace {

template <int D>
GaussianMap<D> withCoarserScales(MapScale<D> finest, const Grid<D>& grid) {
  std::vector<MapScale<D>> scales(static_cast<std::size_t>(grid.scales()));
  scales.front() = std::move(finest);
  for (std::size_t s = 1; s < scales.size(); ++s) scales[s] = coarsen<D>(scales[s - 1], grid, static_cast<int>(s) - 1);
  return GaussianMap<D>(grid.options(), std::move(scales));
}

}  // namespace

template <int D>
GaussianMap<D> build(const MomentGrid<D>& moments, const MapOptions& options) {
  const Grid<D> grid(options);
  require(moments.resolution() == options.resolution, "resolution", options.resolution,
          "must be equal to the resolution of the moments, which is " + numberText(moments.resolution()) + " m");
  std::vector<CellKey<D>> keys(moments.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = moments[i].key;
  const std::vector<std::uint32_t> order = keyOrder<D>(keys, options.ratio, options.scales - 1);
  MapScale<D> finest;
  finest.keys.resize(keys.size());
  finest.moments.resize(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    finest.keys[i] = keys[order[i]];
    finest.moments[i] = moments[order[i]].moments;
  }
  return withCoarserScales<D>(std::move(finest), grid);
}

template <int D>
GaussianMap<D> build(const std::vector<Vector<D>>& points, const MapOptions& options) {
  MomentGrid<D> moments(Grid<D>(options).options().resolution);
  moments.addPoints(points);
  return build<D>(moments, options);
}

template <int D>
GaussianMap<D> build(const MapScale<D>& cells, const MapOptions& options) {
  if (cells.keys.size() != cells.gaussians.size())
    throw std::invalid_argument("the finest scale must have exactly one Gaussian per cell");
  MapScale<D> finest;
  for (const std::uint32_t from : keyOrder<D>(cells.keys, options.ratio, options.scales - 1)) {
    finest.keys.push_back(cells.keys[from]);
    finest.gaussians.push_back(cells.gaussians[from]);
  }
  return withCoarserScales<D>(std::move(finest), Grid<D>(options));
}

template <int D>
GaussianMap<D> build(const Scans& scans, const MapOptions& options, AccumulateOptions reading, PointCounts* counts) {
  reading.resolution = Grid<D>(options).options().resolution;
  const AccumulatedScans<D> accumulated = accumulateScans<D>(scans, reading);
  if (counts != nullptr) *counts = accumulated.counts;
  return build<D>(accumulated.moments, options);
}

#define GAUSSMAP_INSTANTIATE(D)                                                         \
  template GaussianMap<D> build<D>(const MomentGrid<D>&, const MapOptions&);            \
  template GaussianMap<D> build<D>(const std::vector<Vector<(D)>>&, const MapOptions&); \
  template GaussianMap<D> build<D>(const MapScale<D>&, const MapOptions&);              \
  template GaussianMap<D> build<D>(const Scans&, const MapOptions&, AccumulateOptions, PointCounts*);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
