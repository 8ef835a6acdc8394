// SPDX-License-Identifier: BSD-3-Clause
// The contents of the XML section of an E57 file that concern scans.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

enum class E57Encoding { Integer, ScaledInteger, Single, Double, String };

/// One field of each point.
struct E57Field {
  std::string name;  ///< with the prefix of its namespace, if it has one
  E57Encoding encoding = E57Encoding::Double;
  std::int64_t minimum = 0, maximum = 0;  ///< of integers; of scaled integers before scaling
  double scale = 1.0, offset = 0.0;       ///< of scaled integers: value = integer * scale + offset

  /// Returns the largest number that the packets can hold for an integer: they store integer - minimum.
  std::uint64_t range() const { return static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum); }
  /// Returns the number of bits per point; 0 for strings and for integers with only one possible value.
  unsigned bits() const {
    switch (encoding) {
      case E57Encoding::Single:
        return 32;
      case E57Encoding::Double:
        return 64;
      case E57Encoding::String:
        return 0;
      default:
        return range() == 0 ? 0u : 64u - static_cast<unsigned>(__builtin_clzll(range()));
    }
  }
};

/// The smallest and the largest value of a colour.
struct E57Limits {
  double minimum = 0.0, maximum = 0.0;
};

struct E57Scan {
  std::string name;                                             ///< the name, else the guid; can be empty
  std::optional<Pose> pose = std::nullopt;                      ///< as written, not checked
  std::optional<std::chrono::nanoseconds> time = std::nullopt;  ///< GPS time of the start
  std::uint64_t section = 0;                                    ///< physical offset of the section of points
  std::uint64_t points = 0;                                     ///< as the XML claims
  std::vector<E57Field> fields;
  std::array<std::optional<E57Limits>, 3> colour_limits;  ///< red, green, blue
};

struct E57Description {
  std::vector<E57Scan> scans;
  std::string coordinate_system;  ///< WKT; empty if not given
  std::size_t images = 0;
};

}  // namespace gaussmap::detail
