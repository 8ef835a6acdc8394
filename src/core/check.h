// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "core/number_text.h"

namespace gaussmap::detail {

/// Checks the value of an option. Throws std::invalid_argument if it is not usable: "cell = -1: must be positive".
/// `rule` is the requirement: "must be positive", "must be at least 1 (0 = all)".
inline void require(bool usable, const std::string& option, double value, const std::string& rule) {
  if (!usable) throw std::invalid_argument(option + " = " + numberText(value) + ": " + rule);
}

}  // namespace gaussmap::detail
