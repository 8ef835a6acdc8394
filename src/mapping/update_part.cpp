// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/update_part.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "map/map_scale_builder.h"
#include "map/occupied_areas.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {
namespace {

/// A scale of the updated part, and which of its cells have new points.
template <int D>
struct NewScale {
  MapScale<D> cells;
  std::vector<char> changed;  // per cell
  std::vector<double> areas;  // per Gaussian: number of occupied finest cells that it represents
};

/// Returns the finest scale with the new moments added.
template <int D>
NewScale<D> addMoments(const GaussianMap<D>& old, const MomentGrid<D>& added, bool occupancy) {
  MapScale<D> cells = old.scale(0);
  std::vector<char> changed(cells.keys.size(), 0);
  for (std::size_t i = 0; i < added.size(); ++i) {
    const auto known = old.find(added[i].key, 0);
    if (known) {
      cells.moments[*known] += added[i].moments;
      changed[*known] = 1;
      continue;
    }
    cells.keys.push_back(added[i].key);
    cells.moments.push_back(added[i].moments);
    if (occupancy) cells.log_odds.push_back(kMaxOccupancy);
    changed.push_back(1);
  }
  MapScaleBuilder<D> finest;
  std::vector<char> ordered_changed;
  for (const std::uint32_t from : keyOrder<D>(cells.keys, old.options().ratio, old.scales() - 1)) {
    finest.copyCell(cells, from);
    ordered_changed.push_back(changed[from]);
  }
  return {finest.take(), std::move(ordered_changed), std::vector<double>(cells.keys.size(), 1.0)};
}

/// The cells of the next coarser scale, and which of them have new points under them.
template <int D>
struct ParentCells {
  std::vector<CellKey<D>> keys;
  std::vector<std::uint32_t> first_child;
  std::vector<char> changed;
};

template <int D>
ParentCells<D> parentCells(const NewScale<D>& finer, const Grid<D>& grid, int finer_scale) {
  ParentCells<D> coarse;
  for (std::size_t child = 0; child < finer.cells.keys.size(); ++child) {
    const CellKey<D> key = grid.ancestor(finer.cells.keys[child], finer_scale, finer_scale + 1);
    if (coarse.keys.empty() || coarse.keys.back() != key) {
      coarse.keys.push_back(key);
      coarse.first_child.push_back(static_cast<std::uint32_t>(child));
      coarse.changed.push_back(0);
    }
    coarse.changed.back() |= finer.changed[child];
  }
  coarse.first_child.push_back(static_cast<std::uint32_t>(finer.cells.keys.size()));
  return coarse;
}

/// Returns the finer cells under the changed coarse cells, as a scale.
template <int D>
NewScale<D> underChanged(const NewScale<D>& finer, const ParentCells<D>& coarse) {
  MapScaleBuilder<D> cells;
  std::vector<double> areas;
  for (std::size_t cell = 0; cell < coarse.changed.size(); ++cell)
    for (std::size_t child = coarse.first_child[cell]; coarse.changed[cell] && child < coarse.first_child[cell + 1];
         ++child) {
      const IndexRange range = gaussiansOf(finer.cells, child);
      cells.copyCell(finer.cells, child);
      for (std::size_t i = range.first; i < range.last; ++i) areas.push_back(finer.areas[i]);
    }
  return {cells.take(), {}, std::move(areas)};
}

/// Builds a coarse scale from unchanged cells and rebuilt cells.
template <int D>
class CoarseScaleOfPart {
 public:
  explicit CoarseScaleOfPart(std::vector<std::uint32_t>& parents) : parents_(parents) {}

  /// Adds a cell with its Gaussians, and links the finer Gaussians under it to them.
  void take(const CellKey<D>& key, const MapScale<D>& from, IndexRange gaussians,
            const std::vector<std::uint32_t>& old_parents, IndexRange under) {
    cells_.addCell(key);
    const std::size_t first = cells_.gaussians();
    for (std::size_t i = gaussians.first; i < gaussians.last; ++i) cells_.addGaussian(from.gaussians[i]);
    for (std::size_t i = under.first; i < under.last; ++i)
      parents_.push_back(static_cast<std::uint32_t>(old_parents[i] - gaussians.first + first));
  }
  void addLogOdds(float log_odds) { cells_.addLogOdds(log_odds); }
  MapScale<D> finish() { return cells_.take(); }

 private:
  MapScaleBuilder<D> cells_;
  std::vector<std::uint32_t>& parents_;  // of the finer scale
};

}  // namespace

template <int D>
GaussianMap<D> updatePart(const GaussianMap<D>& old, const MomentGrid<D>& added, bool occupancy,
                          const RefineOptions& options,
                          const std::function<std::size_t(int scale, std::size_t cells)>& maxGaussians) {
  const Grid<D>& grid = old.grid();
  std::vector<MapScale<D>> scales;
  NewScale<D> finer = addMoments<D>(old, added, occupancy);
  for (int s = 1; s < old.scales(); ++s) {
    ParentCells<D> parents = parentCells<D>(finer, grid, s - 1);
    std::size_t staying = 0;  // Gaussians in unchanged cells
    for (std::size_t cell = 0; cell < parents.changed.size(); ++cell)
      if (!parents.changed[cell]) staying += old.gaussiansOf(*old.find(parents.keys[cell], s), s).size();

    NewScale<D> under = underChanged<D>(finer, parents);
    MapScale<D> rebuilt = coarsen<D>(under.cells, grid, s - 1);
    const ScalePair<D> pair{under.cells, rebuilt, grid, s - 1};
    const std::size_t most = maxGaussians(s, parents.changed.size()), taken = staying + pair.cells();
    if (most > taken)
      setClusters(pair, ScaleClusters::under(pair, under.areas, options.merge_cost, options.threads).cut(most - taken),
                  options.threads);

    CoarseScaleOfPart<D> coarse(finer.cells.parent);
    std::size_t next = 0;  // next rebuilt cell
    for (std::size_t cell = 0; cell < parents.changed.size(); ++cell) {
      const CellKey<D>& key = parents.keys[cell];
      if (parents.changed[cell]) {
        const IndexRange range = gaussiansOf(rebuilt, next);
        coarse.take(key, rebuilt, range, under.cells.parent, pair.gaussiansUnder(next));
        for (std::size_t i = range.first; occupancy && i < range.last; ++i) coarse.addLogOdds(kMaxOccupancy);
        ++next;
      } else {
        const std::size_t before = *old.find(key, s);
        const IndexRange range = old.gaussiansOf(before, s);
        coarse.take(key, old.scale(s), range, old.scale(s - 1).parent, old.gaussiansUnder(before, s));
        for (std::size_t i = range.first; occupancy && i < range.last; ++i) coarse.addLogOdds(old.logOdds(i, s));
      }
    }
    MapScale<D> cells = coarse.finish();
    cells.first_child = std::move(parents.first_child);
    if (occupancy) {
      MapScale<D> followed = cells;
      inheritOccupancy<D>(finer.cells, followed);
      for (std::size_t cell = 0; cell < parents.changed.size(); ++cell) {
        const IndexRange range = gaussiansOf(cells, cell);
        for (std::size_t i = range.first; parents.changed[cell] && i < range.last; ++i)
          cells.log_odds[i] = followed.log_odds[i];
      }
    }
    std::vector<double> areas = coarserAreas(finer.cells, finer.areas, cells.gaussianCount());
    scales.push_back(std::move(finer.cells));
    finer = {std::move(cells), std::move(parents.changed), std::move(areas)};
  }
  scales.push_back(std::move(finer.cells));
  return GaussianMap<D>(old.options(), std::move(scales));
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                  \
  template GaussianMap<D> updatePart<D>(const GaussianMap<D>&, const MomentGrid<D>&, bool, const RefineOptions&, \
                                        const std::function<std::size_t(int, std::size_t)>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
