// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/update_part.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "mapping/refine_scale.h"

namespace gaussmap::detail {
namespace {

/// A scale of the new part, and which of its cells have new points.
template <int D>
struct NewScale {
  MapScale<D> cells;
  std::vector<char> changed;  // per cell
  std::vector<double> areas;  // per Gaussian, occupied finest cells that it stands for
};

/// The finest scale with the new sums.
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
  NewScale<D> finest;
  for (const std::uint32_t from : keyOrder<D>(cells.keys, old.options().ratio, old.scales() - 1)) {
    finest.cells.keys.push_back(cells.keys[from]);
    finest.cells.moments.push_back(cells.moments[from]);
    if (occupancy) finest.cells.log_odds.push_back(cells.log_odds[from]);
    finest.changed.push_back(changed[from]);
  }
  finest.areas.assign(finest.cells.keys.size(), 1.0);
  return finest;
}

/// The cells above, without Gaussians yet.
template <int D>
NewScale<D> parentCells(const NewScale<D>& finer, const Grid<D>& grid, int finer_scale) {
  NewScale<D> coarse;
  for (std::size_t child = 0; child < finer.cells.keys.size(); ++child) {
    const CellKey<D> key = grid.ancestor(finer.cells.keys[child], finer_scale, finer_scale + 1);
    if (coarse.cells.keys.empty() || coarse.cells.keys.back() != key) {
      coarse.cells.keys.push_back(key);
      coarse.cells.first_child.push_back(static_cast<std::uint32_t>(child));
      coarse.changed.push_back(0);
    }
    coarse.changed.back() |= finer.changed[child];
  }
  coarse.cells.first_child.push_back(static_cast<std::uint32_t>(finer.cells.keys.size()));
  return coarse;
}

/// What lies under the coarse cells that changed, as a scale of its own.
template <int D>
NewScale<D> underChanged(const NewScale<D>& finer, const NewScale<D>& coarse) {
  NewScale<D> under;
  MapScale<D>& to = under.cells;
  const MapScale<D>& from = finer.cells;
  to.first_gaussian.push_back(0);
  for (std::size_t cell = 0; cell < coarse.changed.size(); ++cell)
    for (std::size_t child = coarse.cells.first_child[cell];
         coarse.changed[cell] && child < coarse.cells.first_child[cell + 1]; ++child) {
      const IndexRange range = gaussiansOf(from, child);
      to.keys.push_back(from.keys[child]);
      if (!from.moments.empty()) to.moments.push_back(from.moments[child]);
      for (std::size_t i = range.first; i < range.last; ++i) {
        if (!from.gaussians.empty()) to.gaussians.push_back(from.gaussians[i]);
        under.areas.push_back(finer.areas[i]);
      }
      to.first_gaussian.push_back(static_cast<std::uint32_t>(under.areas.size()));
    }
  return under;
}

/// Takes the Gaussians of a coarse cell over, and how the finer ones are linked to them.
/// `old_parents` = parents of the finer Gaussians under the cell, `old_first` = the first Gaussian of the cell there.
template <int D>
void takeCell(NewScale<D>& coarse, MapScale<D>& finer, const MapScale<D>& from, IndexRange gaussians,
              const std::vector<std::uint32_t>& old_parents, IndexRange under) {
  const std::size_t first = coarse.cells.gaussians.size();
  for (std::size_t i = gaussians.first; i < gaussians.last; ++i) coarse.cells.gaussians.push_back(from.gaussians[i]);
  for (std::size_t i = under.first; i < under.last; ++i)
    finer.parent.push_back(static_cast<std::uint32_t>(old_parents[i] - gaussians.first + first));
  coarse.cells.first_gaussian.push_back(static_cast<std::uint32_t>(coarse.cells.gaussians.size()));
}

}  // namespace

template <int D>
GaussianMap<D> updatePart(const GaussianMap<D>& old, const MomentGrid<D>& added, bool occupancy,
                          const RefineOptions& options,
                          const std::function<std::size_t(int scale, std::size_t cells)>& mostGaussians) {
  const Grid<D>& grid = old.grid();
  std::vector<MapScale<D>> scales;
  NewScale<D> finer = addMoments<D>(old, added, occupancy);
  for (int s = 1; s < old.scales(); ++s) {
    NewScale<D> coarse = parentCells<D>(finer, grid, s - 1);
    std::size_t staying = 0;  // Gaussians in cells that stay as they are
    for (std::size_t cell = 0; cell < coarse.changed.size(); ++cell)
      if (!coarse.changed[cell]) staying += old.gaussiansOf(*old.find(coarse.cells.keys[cell], s), s).size();

    NewScale<D> under = underChanged<D>(finer, coarse);
    MapScale<D> anew = coarsen<D>(under.cells, grid, s - 1);
    const CoarseScale<D> scale{under.cells, anew, grid, s - 1};
    const std::size_t most = mostGaussians(s, coarse.changed.size()), taken = staying + scale.cells();
    if (most > taken) {
      CoarseScale<D>(scale).replaceGaussians(ScaleCuts<D>(scale, under.areas, options).clusters(most - taken));
    }

    coarse.cells.first_gaussian.push_back(0);
    std::size_t next = 0;  // of the cells made anew
    for (std::size_t cell = 0; cell < coarse.changed.size(); ++cell) {
      if (coarse.changed[cell]) {
        takeCell<D>(coarse, finer.cells, anew, gaussiansOf(anew, next), under.cells.parent, scale.gaussiansUnder(next));
        if (occupancy) coarse.cells.log_odds.resize(coarse.cells.gaussians.size(), kMaxOccupancy);
        ++next;
      } else {
        const std::size_t before = *old.find(coarse.cells.keys[cell], s);
        const IndexRange range = old.gaussiansOf(before, s);
        takeCell<D>(coarse, finer.cells, old.scale(s), range, old.scale(s - 1).parent, old.gaussiansUnder(before, s));
        for (std::size_t i = range.first; occupancy && i < range.last; ++i)
          coarse.cells.log_odds.push_back(old.logOdds(i, s));
      }
    }
    if (occupancy) {
      MapScale<D> followed = coarse.cells;
      inheritOccupancy<D>(finer.cells, followed);
      for (std::size_t cell = 0; cell < coarse.changed.size(); ++cell)
        for (std::size_t i = coarse.cells.first_gaussian[cell];
             coarse.changed[cell] && i < coarse.cells.first_gaussian[cell + 1]; ++i)
          coarse.cells.log_odds[i] = followed.log_odds[i];
    }
    coarse.areas.assign(coarse.cells.gaussians.size(), 0.0);
    for (std::size_t i = 0; i < finer.areas.size(); ++i) coarse.areas[finer.cells.parent[i]] += finer.areas[i];
    if (coarse.cells.gaussians.size() == coarse.cells.keys.size()) coarse.cells.first_gaussian.clear();
    scales.push_back(std::move(finer.cells));
    finer = std::move(coarse);
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
