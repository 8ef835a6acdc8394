// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/moving/moving_points.h"
#include "sensor/default_lengths.h"

namespace gaussmap::detail {

/// Returns the options with all lengths set, for a map whose finest cells have the side `side` [m].
inline MovingCellOptions forCells(MovingCellOptions options, double side) {
  const double factor = lengthFactor(side);
  if (!options.link) options.link = factor * 0.2;
  if (!options.reach) options.reach = factor * 0.5;
  return options;
}
inline SharedCellOptions forCells(SharedCellOptions options, double side) {
  const double factor = lengthFactor(side);
  if (!options.reach) options.reach = factor * 0.6;
  if (!options.flatness) options.flatness = factor * 0.04;
  if (!options.noise) options.noise = factor * 0.01;
  if (!options.extent) options.extent = factor * 0.05;
  return options;
}

}  // namespace gaussmap::detail
