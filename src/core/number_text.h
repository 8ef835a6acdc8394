// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace gaussmap::detail {

/// A number as messages quote it: the shortest text that gives back the same double, whole numbers below 10^15 without
/// an exponent: "1e-09", "0.25", "100000", "inf", "nan". Does not depend on the locale.
std::string numberText(double value);

}  // namespace gaussmap::detail
