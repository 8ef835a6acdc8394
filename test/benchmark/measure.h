// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace gaussmap::benchmark {

struct Measured {
  double seconds = 0.0;    ///< wall time
  double megabytes = 0.0;  ///< peak of resident memory above what was there before; of a command, all of it
  double value = 0.0;      ///< what the work returned
};

/// Runs every work `runs` times, each round in random order, each time in a child process of its own: what one leaves
/// in memory or caches is no other's gain. The least of the times, the largest memory. The works must not have started
/// threads before. Warm: the time is that of a second call in the same process. Throws std::runtime_error if a child
/// fails.
enum class Start { Cold, Warm };
std::vector<Measured> measureInTurn(const std::vector<std::function<double()>>& works, int runs,
                                    Start start = Start::Cold);

/// The same for whole commands: program and arguments, output thrown away.
std::vector<Measured> measureCommandsInTurn(const std::vector<std::vector<std::string>>& commands, int runs);

}  // namespace gaussmap::benchmark
