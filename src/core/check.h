// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "core/number_text.h"

namespace gaussmap::detail {

/// Throws std::invalid_argument unless the value of an option is usable: "cell = -1: must be positive". `rule` says
/// what is required: "must be positive", "must be at least 1 (0 = all)".
inline void require(bool usable, const std::string& option, double value, const std::string& rule) {
  if (!usable) throw std::invalid_argument(option + " = " + numberText(value) + ": " + rule);
}

}  // namespace gaussmap::detail
