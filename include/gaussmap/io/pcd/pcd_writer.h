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

/// One field of a PCD file and the memory that holds its values. The caller keeps the memory alive during the write.
struct PcdOutput {
  std::string name;            ///< one word
  char type = 'F';             ///< I, U or F
  std::size_t size = 4;        ///< bytes per value: 4 or 8 for F; 1, 2, 4 or 8 for I and U
  std::size_t count = 1;       ///< values per point, consecutive in memory
  const void* data = nullptr;  ///< values of the first point
  std::size_t stride = 0;      ///< bytes from the values of one point to those of the next; 0: size * count
};

/// Makes a field of an array; type and size follow from T. `data` holds `count` values per point. `stride` is the
/// number of bytes from point to point; 0: no gaps.
template <typename T>
PcdOutput pcdOutput(std::string name, const T* data, std::size_t count = 1, std::size_t stride = 0) {
  static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= 8, "no type of PCD");
  const char type = std::is_floating_point_v<T> ? 'F' : std::is_signed_v<T> ? 'I' : 'U';
  return {std::move(name), type, sizeof(T), count, data, stride};
}

/// Throws std::invalid_argument if a PCD file cannot have these fields. The message gives the field. The cases are:
/// - There are no fields.
/// - A name is not one word of printable ASCII characters, or it occurs twice.
/// - PCD does not have the type and size of a field (see PcdOutput::size).
/// - A count is 0.
///
/// The addresses of the values are not checked.
GAUSSMAP_API void checkPcdFields(const std::vector<PcdOutput>& fields);

/// Writes a binary PCD file (version 0.7) with any fields: one row of points, or rows of `width` points if `width` is
/// not 0.
///
/// The write is atomic, and the same input gives the same bytes. An empty cloud is written as well, although PCL does
/// not read it. Throws std::invalid_argument like checkPcdFields(), and also if a field has no data, the pose has a
/// fault, the last row is not full, or there are more than 2^32 - 1 points. Throws FileError if the file cannot be
/// written.
GAUSSMAP_API void writePcd(const std::filesystem::path& path, std::size_t points, const std::vector<PcdOutput>& fields,
                           const std::optional<Pose>& viewpoint = std::nullopt, std::size_t width = 0);

/// The type of the coordinates in a PCD file.
enum class PcdPrecision {
  Float,  ///< F4: for any reader; rounds to steps of 4 mm at 65 km from the origin, 1 m at 10,000 km
  Double  ///< F8: exact; PCL's own point types do not read it
};

/// Writes points as x y z [m] to a binary PCD file. NaN is written as NaN. Throws like writePcd() with fields, and
/// std::invalid_argument if a coordinate is too large for a float; the message gives the index of the point.
GAUSSMAP_API void writePcd(const std::filesystem::path& path, const std::vector<Vector<3>>& points,
                           PcdPrecision precision = PcdPrecision::Float,
                           const std::optional<Pose>& viewpoint = std::nullopt);

}  // namespace gaussmap
