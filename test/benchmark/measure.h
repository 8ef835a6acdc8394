// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace gaussmap::benchmark {

struct Measured {
  double seconds = 0.0;    ///< wall time
  double megabytes = 0.0;  ///< peak of resident memory, minus the memory before; for a command, the whole peak
  double value = 0.0;      ///< the value that the work returned
};

/// Runs every work `runs` times and returns its minimum time and maximum memory. Each round has a random order. Each
/// run has its own child process, so no work profits from the memory or the caches of another one. The process must not
/// have started threads before. Warm: the time is that of a second call in the same child process. Throws
/// std::runtime_error if a child fails.
enum class Start { Cold, Warm };
std::vector<Measured> measureInTurn(const std::vector<std::function<double()>>& works, int runs,
                                    Start start = Start::Cold);

/// Does the same for whole commands: program and arguments. Their output is discarded.
std::vector<Measured> measureCommandsInTurn(const std::vector<std::vector<std::string>>& commands, int runs);

}  // namespace gaussmap::benchmark
