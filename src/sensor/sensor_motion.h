// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>

#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// How well two scans agree with a sensor that stands still. It then measures about as many points in a direction, at
/// the same range.
struct GAUSSMAP_API SameView {
  std::size_t first = 0, second = 0;  ///< numbers of the two scans
  double density = 1.0;  ///< ratio of the numbers of points, fewer / more, over the directions with points of both
  double range = 1.0;    ///< share of the points in these directions whose typical range is the same
  double least_density = 0.0;  ///< the least density of scans of one place: lower if there are few points per direction

  /// Returns true if the scans show that the sensor moved between them.
  bool moved() const;
};

/// Compares up to eight scans that all have the same sensor position, pair by pair, as they look from this position.
///
/// Returns one of the worst pairs: with four scans or more, one scan that differs from all others is ignored, for
/// example if a truck stood before the sensor. Returns std::nullopt if the positions differ, or if no pair can be
/// compared: fewer than two scans have points, or no two scans look in the same direction. Throws like Scans::read().
GAUSSMAP_API std::optional<SameView> compareViews(const Scans& scans);

}  // namespace gaussmap::detail
