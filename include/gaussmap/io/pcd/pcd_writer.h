// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// One field of a PCD file and where its values are in memory. The caller keeps the memory alive while writing.
struct PcdOutput {
  std::string name;            ///< one word
  char type = 'F';             ///< I, U or F
  std::size_t size = 4;        ///< bytes a value: 4 or 8 for F, 1, 2, 4 or 8 for I and U
  std::size_t count = 1;       ///< values a point, side by side in memory
  const void* data = nullptr;  ///< the values of the first point
  std::size_t stride = 0;      ///< bytes from one point's values to the next's; 0: size * count
};

/// A field from an array: type and size follow from T. `data` holds `count` values per point, or `stride` bytes apart.
template <typename T>
PcdOutput pcdOutput(std::string name, const T* data, std::size_t count = 1, std::size_t stride = 0) {
  static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= 8, "no type of PCD");
  const char type = std::is_floating_point_v<T> ? 'F' : std::is_signed_v<T> ? 'I' : 'U';
  return {std::move(name), type, sizeof(T), count, data, stride};
}

/// Throws std::invalid_argument, naming the field, for fields that no PCD file can have: no name or blanks in it, the
/// same name twice, a type and size that there is not, a count of 0. Where the values are does not matter.
GAUSSMAP_API void checkPcdFields(const std::vector<PcdOutput>& fields);

/// Writes a binary PCD file (version 0.7) with any fields, whole or not at all (AtomicFile): one row of points, or rows
/// of `width` points if that is not 0.
/// The same input gives the same bytes. An empty cloud is written too, though PCL refuses to read one.
/// Throws std::invalid_argument as checkPcdFields(), for a field without data, a pose with a fault, or rows that are
/// not full; FileError if the file cannot be written.
GAUSSMAP_API void writePcd(const std::filesystem::path& path, std::size_t points, const std::vector<PcdOutput>& fields,
                           const std::optional<Pose>& viewpoint = std::nullopt, std::size_t width = 0);

enum class PcdPrecision {
  Float,  ///< F4: what every reader takes; resolves 4 mm at 65 km from the origin, 1 m at 10,000 km
  Double  ///< F8: exact; PCL's own point types do not read it
};

/// Writes points as x y z [m]. NaN is written as it is. Throws as above, and std::invalid_argument, naming the
/// index, for a coordinate too large for a float.
GAUSSMAP_API void writePcd(const std::filesystem::path& path, const std::vector<Vector<3>>& points,
                           PcdPrecision precision = PcdPrecision::Float,
                           const std::optional<Pose>& viewpoint = std::nullopt);

}  // namespace gaussmap
