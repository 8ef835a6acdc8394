// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/shared_cells.h"

#include <algorithm>

#include "core/check.h"
#include "core/parallel.h"
#include "map/near_cells.h"
#include "mapping/moving/check_options.h"

namespace gaussmap::detail {
void checkOptions(const SharedCellOptions& options, double resolution) {
  require(options.reach >= 0.0 && options.reach <= kMostCells * resolution, "reach of a surface", options.reach,
          "must be 0 to 1000 cells");
  require(options.flatness >= 0.0, "flatness", options.flatness, "must not be negative");
  require(options.noise >= 0.0, "noise", options.noise, "must not be negative");
}

SharedCells findSharedCells(const GaussianMap<3>& map, const std::vector<bool>& moving,
                            const std::vector<Evidence>& evidence) {
  SharedCells shared;
  for (std::size_t cell = 0; cell < moving.size(); ++cell) {
    if (!moving[cell]) continue;
    const std::uint32_t first = evidence[cell].first_hit, last = evidence[cell].last_hit;
    const auto widen = [&](std::size_t near) {
      SharedCell& entry = shared.try_emplace(near, SharedCell{first, last}).first->second;
      entry.first_scan = std::min(entry.first_scan, first);
      entry.last_scan = std::max(entry.last_scan, last);
    };
    widen(cell);
    forNearCells(map, cell, 1, 1, widen);
  }
  return shared;
}

void fitSurfaces(const GaussianMap<3>& map, const MomentGrid<3>& still, const SharedCellOptions& options, int threads,
                 SharedCells& shared) {
  const double side = map.grid().side(0);
  const std::int32_t reach = cellsFor(options.reach, side);
  std::unordered_map<std::size_t, CellMoments<3>> between;  // what is left of the shared cells
  for (std::size_t i = 0; i < still.size(); ++i)
    if (const auto cell = map.find(still[i].key, 0)) between.emplace(*cell, still[i].moments);

  std::vector<std::pair<const std::size_t, SharedCell>*> entries;
  for (auto& entry : shared) entries.push_back(&entry);
  parallelFor(entries.size(), threads, 64, [&](std::size_t i) {
    const std::size_t cell = entries[i]->first;
    const CellKey<3> key = map.scale(0).keys[cell];
    SurfaceSums<3> sums;
    const auto add = [&](std::size_t near) {
      const CellMoments<3>* moments = &map.scale(0).moments[near];
      if (shared.count(near) > 0) {
        const auto found = between.find(near);
        if (found == between.end()) return;
        moments = &found->second;
      }
      const CellKey<3> other = map.scale(0).keys[near];
      sums.add(*moments, side, side * Eigen::Vector3d(other[0] - key[0], other[1] - key[1], other[2] - key[2]));
    };
    add(cell);
    for (std::int32_t ring = 1; ring <= reach && !entries[i]->second.surface; ++ring) {
      forNearCells(map, cell, ring, ring, add);
      entries[i]->second.surface = sums.surface(options.flatness);
    }
  });
}

}  // namespace gaussmap::detail
