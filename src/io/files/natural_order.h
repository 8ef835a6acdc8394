// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gaussmap::detail {

/// Returns true if a comes before b in natural order: numbers in names are compared by value, for example
/// scan2 before scan10.
bool naturalLess(const std::string& a, const std::string& b);

}  // namespace gaussmap::detail
