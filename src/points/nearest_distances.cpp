// SPDX-License-Identifier: BSD-3-Clause
#include "points/nearest_distances.h"

#include <stdexcept>

#include "points/nearest_search.h"

namespace gaussmap::detail {

std::vector<double> nearestDistances(const std::vector<Vector<3>>& from, const std::vector<Vector<3>>& to,
                                     int threads) {
  checkPoints(from, "from");
  checkPoints(to, "to");
  if (from.empty()) return {};
  if (to.empty()) throw std::invalid_argument("nearestDistances: no point in 'to'");
  const PointTreePair trees(from, to, threads);
  return nearestDistances(trees.a(), trees.b(), threads);
}

}  // namespace gaussmap::detail
