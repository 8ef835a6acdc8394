// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/map/queries.h"

namespace gaussmap::detail {

/// Returns the Gaussians of one scale, or of all scales from the coarsest to the finest if `scale` is std::nullopt.
/// Throws std::out_of_range if the map does not have the scale.
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
