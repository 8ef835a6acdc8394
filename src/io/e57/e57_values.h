// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/e57/e57_description.h"

namespace gaussmap::detail {

/// The fields that hold the coordinates of a point.
struct E57Coordinates {
  std::array<std::size_t, 3> fields{};                ///< x, y, z; or range, azimuth, elevation
  bool is_spherical = false;                          ///< false: cartesian
  std::optional<std::size_t> invalid = std::nullopt;  ///< the field that is not 0 for invalid points
};

/// Returns the coordinates of a scan, cartesian if there are both kinds. Returns std::nullopt if no kind is complete.
std::optional<E57Coordinates> coordinatesOf(const E57Scan& scan);

/// One value per point that is not a coordinate.
struct E57Value {
  std::string name;                                   ///< of the interface ScanReader
  std::vector<std::size_t> fields;                    ///< one field; or red, green and blue
  std::optional<std::size_t> invalid = std::nullopt;  ///< the field that is not 0 if the value is invalid
  std::array<E57Limits, 3> limits{};                  ///< of red, green and blue: they are scaled to 0 ... 255
};

/// Returns the values of a scan, with different names.
std::vector<E57Value> valuesOf(const E57Scan& scan, const E57Coordinates& coordinates);

}  // namespace gaussmap::detail
