// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/moving_cells.h"

#include <stdexcept>
#include <string>

#include "core/check.h"
#include "map/neighbour_keys.h"
#include "mapping/moving/check_options.h"
#include "mapping/moving/default_lengths.h"
#include "mapping/moving/map_cells.h"
#include "mapping/moving/object_rules.h"

namespace gaussmap::detail {
namespace {

/// Removes the flags of connected groups of freed cells with fewer than `min_points` points. Such a group is noise.
void restoreSmallGroups(const FinestMapCells& cells, const MovingCellOptions& options, std::vector<bool>& freed) {
  const std::int32_t link = cellsFor(*options.link, cells.side());
  std::vector<bool> seen(freed.size());
  std::vector<std::size_t> group;
  for (std::size_t seed = 0; seed < freed.size(); ++seed) {
    if (!freed[seed] || seen[seed]) continue;
    group.assign(1, seed);
    seen[seed] = true;
    double points = 0.0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      points += cells.map.localGaussian(group[i], 0).weight;
      forNearCells(cells, cells.key(group[i]), 1, link, [&](std::size_t near) {
        if (!freed[near] || seen[near]) return;
        seen[near] = true;
        group.push_back(near);
      });
    }
    if (points < options.min_points)
      for (const std::size_t cell : group) freed[cell] = false;
  }
}

}  // namespace

void checkOptions(const MovingCellOptions& options, double resolution) {
  require(options.occupancy.hit > 0.0, "hit", options.occupancy.hit, "must be positive");
  require(options.occupancy.miss > 0.0, "miss", options.occupancy.miss, "must be positive");
  require(options.min_points >= 0.0, "min_points", options.min_points, "must not be negative");
  require(options.min_points_of_camera >= 0.0, "min_points_of_camera", options.min_points_of_camera,
          "must not be negative");
  const MovingCellOptions lengths = forCells(options, resolution);
  require(*lengths.link >= 0.0 && *lengths.link <= kMaxCells * resolution, "link", *lengths.link,
          "must be 0 to 1000 cells");
  require(*lengths.reach >= 0.0, "reach", *lengths.reach, "must not be negative");
}

std::vector<bool> findMovingCells(const GaussianMap<3>& map, const std::vector<Evidence>& evidence,
                                  const MovingCellOptions& given) {
  checkOptions(given, map.grid().side(0));
  const MovingCellOptions options = forCells(given, map.grid().side(0));
  if (evidence.size() != map.cellCount(0))
    throw std::invalid_argument(std::to_string(evidence.size()) + " entries of evidence for a map with " +
                                std::to_string(map.cellCount(0)) + " finest cells, expected one per cell");
  const FinestMapCells cells{map, evidence};
  std::vector<bool> moving(evidence.size());
  for (std::size_t cell = 0; cell < moving.size(); ++cell)
    moving[cell] = evidence[cell].hits > 0 && logOdds(evidence[cell], options.occupancy) < 0.0;
  restoreSmallGroups(cells, options, moving);
  std::vector<std::size_t> freed;
  for (std::size_t cell = 0; cell < moving.size(); ++cell)
    if (moving[cell]) freed.push_back(cell);
  const auto of_objects = cellsOfObjects(cells, std::move(freed), *options.link, *options.reach);
  for (const std::size_t cell : of_objects) moving[cell] = true;
  return moving;
}

}  // namespace gaussmap::detail
