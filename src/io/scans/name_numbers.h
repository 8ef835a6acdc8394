// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gaussmap/version.h"
#include "io/scans/time_text.h"

namespace gaussmap::detail {

/// The numbers in the names of scans. The same part of every name is used.
struct NameNumbers {
  std::vector<std::uint64_t> indices;  ///< one per name, all different; empty if the names have none
  std::vector<Decimal> times;          ///< one per name, as written, sec and nsec combined; empty if there are none
  bool dates = false;                  ///< the times are dates, read as UTC
};

/// Reads the times and the numbers in names such as "000007.pcd", "scan_1689000000.123456.pcd" and
/// "lidar_1689000000_123456789.pcd".
///
/// A time is a number of the size of a time of today in s, ms, us or ns, a pair of seconds and fraction or nanoseconds
/// (joined by . _ , or -), a decimal number, or a date with a time of day (UTC). A pair of small seconds needs
/// nanoseconds of 9 digits: "12_300000000.pcd". Of several numbers, the last one that differs between the names counts.
GAUSSMAP_API NameNumbers numbersIn(const std::vector<std::string>& names);

/// Returns the name without its endings. An ending starts with a letter, so "1689000000.5_cloud" has none.
std::string withoutEndings(const std::string& name);

}  // namespace gaussmap::detail
