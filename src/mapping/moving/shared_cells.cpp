// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/shared_cells.h"

#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "mapping/moving/check_options.h"
#include "mapping/moving/default_lengths.h"
#include "mapping/moving/map_cells.h"
#include "mapping/moving/object_rules.h"

namespace gaussmap::detail {
void checkOptions(const SharedCellOptions& options, double resolution) {
  const SharedCellOptions lengths = forCells(options, resolution);
  require(*lengths.reach >= 0.0 && *lengths.reach <= kMaxCells * resolution, "reach of a surface", *lengths.reach,
          "must be 0 to 1000 cells");
  require(*lengths.flatness >= 0.0, "flatness", *lengths.flatness, "must not be negative");
  require(*lengths.noise >= 0.0, "noise", *lengths.noise, "must not be negative");
  require(*lengths.extent >= 0.0, "extent", *lengths.extent, "must not be negative");
}

SharedCells findSharedCells(const GaussianMap<3>& map, const std::vector<bool>& moving,
                            const std::vector<Evidence>& evidence) {
  const FinestMapCells cells{map, evidence};
  SharedCells shared;
  for (std::size_t cell = 0; cell < moving.size(); ++cell)
    if (moving[cell])
      noteSharedCells(cells, cells.key(cell), SharedCell{evidence[cell].first_hit, evidence[cell].last_hit}, shared);
  return shared;
}

void fitSurfaces(const GaussianMap<3>& map, const MomentGrid<3>& still, const SharedCellOptions& given, int threads,
                 SharedCells& shared) {
  const SharedCellOptions options = forCells(given, map.grid().side(0));
  std::unordered_map<std::size_t, CellMoments<3>> between;  // moments of the points in shared cells without the object
  for (std::size_t i = 0; i < still.size(); ++i)
    if (const auto cell = map.find(still[i].key, 0)) between.emplace(*cell, still[i].moments);
  const CellMoments<3> none;
  const auto still_in = [&](std::size_t cell) -> const CellMoments<3>& {
    if (shared.count(cell) == 0) return map.scale(0).moments[cell];
    const auto found = between.find(cell);
    return found == between.end() ? none : found->second;
  };

  const std::vector<Evidence> unused;
  const FinestMapCells cells{map, unused};
  std::vector<std::pair<const std::size_t, SharedCell>*> entries;
  for (auto& entry : shared) entries.push_back(&entry);
  parallelFor(entries.size(), threads, 64, [&](std::size_t i) {
    entries[i]->second.surface = surfaceAt(cells, entries[i]->first, still_in, options);
  });
}

}  // namespace gaussmap::detail
