// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "common/command.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::app {

/// Adds --depth-noise, whose numbers go to `values`.
Option addDepthNoise(Command& command, std::vector<double>& values);
/// Returns the noise that the option states; std::nullopt if it was not given.
std::optional<DepthNoise> depthNoise(const std::vector<double>& values);

}  // namespace gaussmap::app
