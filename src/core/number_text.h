// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns the text of a number for messages: the shortest text that reads back as the same double. Whole numbers below
/// 10^15 have no exponent. Examples: "1e-09", "0.25", "100000", "inf", "nan". It does not depend on the locale.
GAUSSMAP_API std::string numberText(double value);

}  // namespace gaussmap::detail
