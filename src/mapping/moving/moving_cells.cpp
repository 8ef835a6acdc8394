// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/moving/moving_cells.h"

#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "map/near_cells.h"
#include "mapping/moving/check_options.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Takes out the groups of cells that hold fewer points than an object has.
void restoreSmallGroups(const GaussianMap<3>& map, const MovingCellOptions& options, std::vector<bool>& moving) {
  const std::int32_t link = cellsFor(options.link, map.grid().side(0));
  std::vector<bool> seen(moving.size());
  std::vector<std::size_t> group;
  for (std::size_t seed = 0; seed < moving.size(); ++seed) {
    if (!moving[seed] || seen[seed]) continue;
    group.assign(1, seed);
    seen[seed] = true;
    double points = 0.0;
    for (std::size_t i = 0; i < group.size(); ++i) {
      points += map.localGaussian(group[i], 0).weight;
      forNearCells(map, group[i], 1, link, [&](std::size_t near) {
        if (!moving[near] || seen[near]) return;
        seen[near] = true;
        group.push_back(near);
      });
    }
    if (points < options.min_points)
      for (const std::size_t cell : group) moving[cell] = false;
  }
}

void growObjects(const GaussianMap<3>& map, const std::vector<Evidence>& evidence, const MovingCellOptions& options,
                 std::vector<bool>& moving) {
  const std::int32_t link = cellsFor(options.link, map.grid().side(0));
  std::deque<std::pair<std::size_t, std::size_t>> front;  // a cell, and the freed cell that it was reached from
  for (std::size_t cell = 0; cell < moving.size(); ++cell)
    if (moving[cell]) front.emplace_back(cell, cell);
  for (; !front.empty(); front.pop_front()) {
    const std::size_t seed = front.front().second;
    const Evidence& object = evidence[seed];
    const Vector<3> middle = map.gaussian(seed, 0).mean;
    forNearCells(map, front.front().first, 1, link, [&](std::size_t near) {
      if (moving[near] || evidence[near].hits == 0 || evidence[near].first_hit < object.first_hit ||
          evidence[near].last_hit > object.last_hit || (map.gaussian(near, 0).mean - middle).norm() > options.reach)
        return;
      moving[near] = true;
      front.emplace_back(near, seed);
    });
  }
}

}  // namespace

void detail::checkOptions(const MovingCellOptions& options, double resolution) {
  require(options.occupancy.hit > 0.0, "hit", options.occupancy.hit, "must be positive");
  require(options.occupancy.miss > 0.0, "miss", options.occupancy.miss, "must be positive");
  require(options.min_points >= 0.0, "min_points", options.min_points, "must not be negative");
  require(options.link >= 0.0 && options.link <= kMostCells * resolution, "link", options.link,
          "must be 0 to 1000 cells");
  require(options.reach >= 0.0, "reach", options.reach, "must not be negative");
}

std::vector<bool> findMovingCells(const GaussianMap<3>& map, const std::vector<Evidence>& evidence,
                                  const MovingCellOptions& options) {
  checkOptions(options, map.grid().side(0));
  if (evidence.size() != map.cellCount(0))
    throw std::invalid_argument(std::to_string(evidence.size()) + " pieces of evidence for " +
                                std::to_string(map.cellCount(0)) + " cells");
  std::vector<bool> moving(evidence.size());
  for (std::size_t cell = 0; cell < moving.size(); ++cell)
    moving[cell] = evidence[cell].hits > 0 && logOdds(evidence[cell], options.occupancy) < 0.0;
  restoreSmallGroups(map, options, moving);
  growObjects(map, evidence, options, moving);
  return moving;
}

}  // namespace gaussmap
