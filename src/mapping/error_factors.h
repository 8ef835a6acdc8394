// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "mapping/learning_rate.h"

namespace gaussmap::detail {

/// Returns the factors 1 - eps of finer Gaussians for cellError(), Yguel 2009 eq. (6). eps is the learning rate of
/// their log-odds, eq. (5), with the rates of the paper. Returns an empty vector if the scale has no occupancy.
template <int D>
std::vector<double> errorFactors(const MapScale<D>& finer, IndexRange under) {
  std::vector<double> factors;
  if (finer.log_odds.empty()) return factors;
  for (std::size_t i = under.first; i < under.last; ++i)
    factors.push_back(1.0 - LearningRates().at(static_cast<double>(finer.log_odds[i])));
  return factors;
}

}  // namespace gaussmap::detail
