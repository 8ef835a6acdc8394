// SPDX-License-Identifier: BSD-3-Clause
#include "commands/depth_noise.h"

namespace gaussmap::app {

Option addDepthNoise(Command& command, std::vector<double>& values) {
  return command.numbers("--depth-noise", values, 2, 0.0, 1e3,
                         "A B: the standard deviation of a depth z is A + B z^2 [m]; default: \"0 0\" for a lidar, "
                         "0.0012 + 0.0019 (z - 0.4)^2 for a depth camera");
}

std::optional<DepthNoise> depthNoise(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return DepthNoise{values[0], values[1], 0.0};
}

}  // namespace gaussmap::app
