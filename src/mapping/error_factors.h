// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Returns the factors 1 - eps of finer Gaussians for cellError(), Yguel 2009 eq. (6). eps is the learning rate of
/// their log-odds, eq. (5), with the rates of the paper: 5e-2 for free and 5e-4 for occupied ones. Returns an empty
/// vector if the scale has no occupancy.
template <int D>
std::vector<double> errorFactors(const MapScale<D>& finer, IndexRange under) {
  constexpr double kSlowest = 5e-4, kFastest = 5e-2, kMost = static_cast<double>(kMaxOccupancy);
  std::vector<double> factors;
  if (finer.log_odds.empty()) return factors;
  for (std::size_t i = under.first; i < under.last; ++i)
    factors.push_back(1.0 - kFastest +
                      (kFastest - kSlowest) * (static_cast<double>(finer.log_odds[i]) + kMost) / (2.0 * kMost));
  return factors;
}

}  // namespace gaussmap::detail
