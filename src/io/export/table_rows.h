// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/map/queries.h"

namespace gaussmap::detail {

/// The Gaussians of all scales, coarsest first, or of one. Throws std::out_of_range for a scale that there is not.
inline std::vector<GaussianId> tableRows(const GaussianMap<3>& map, std::optional<int> scale) {
  if (scale) return gaussiansOfScale(map, *scale);
  std::vector<GaussianId> rows;
  for (int s = map.scales() - 1; s >= 0; --s) {
    const std::vector<GaussianId> more = gaussiansOfScale(map, s);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  return rows;
}

}  // namespace gaussmap::detail
