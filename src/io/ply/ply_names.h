// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "io/ply/ply_header.h"

namespace gaussmap::detail {

/// A value of each vertex: one property, or three for a colour.
struct PlyValue {
  std::string name;
  std::vector<std::size_t> properties;  ///< numbers of the properties; three for a colour: red, green, blue
};

/// What the properties of a vertex mean.
struct PlyMeaning {
  std::array<std::size_t, 3> axes{};  ///< numbers of the properties x, y, z, or X, Y, Z
  std::vector<PlyValue> values;       ///< in the order of the properties, without lists
};

/// Returns what the properties mean. "scalar_" in front, which CloudCompare writes, is removed, and usual names get the
/// names of PCL: "Intensity" becomes "intensity", "GpsTime" becomes "time", and red, green, blue become "rgb".
/// Returns an error text in `error` if x, y or z is missing or is a list.
PlyMeaning meaningOf(const PlyElement& vertex, std::string& error);

/// Packs colours as r << 16 | g << 8 | b. Floats up to 1 are multiplied by 255, and whole numbers are divided by 256 if
/// any of them exceeds 255. Values that do not fit are limited to 0 and 255; NaN becomes 0.
std::vector<double> packColours(const std::array<std::vector<double>, 3>& channels, bool is_float);

}  // namespace gaussmap::detail
