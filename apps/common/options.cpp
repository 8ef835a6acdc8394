// SPDX-License-Identifier: BSD-3-Clause
#include "common/options.h"

#include <sched.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <thread>

namespace gaussmap::app {
namespace {

template <typename Number>
bool isNumber(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Processors that this process may use.
int processors() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0
             ? CPU_COUNT(&set)
             : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// TBB warns on stderr if it is asked for more threads than there are processors.
std::string limitThreads(std::string& text) {
  int threads = 0;
  if (isNumber(text, threads) && threads <= 1024) text = std::to_string(std::min(threads, processors()));
  return "";
}

std::string checkSeed(std::string& text) {
  std::uint64_t value = 0;
  return isNumber(text, value) ? "" : "'" + text + "' is not a whole number from 0 to 2^64 - 1";
}

}  // namespace

CLI::Validator numberBetween(double low, double high) {
  std::ostringstream range;
  range << low << " to " << high;
  return CLI::Validator(
      [low, high, possible = range.str()](std::string& text) -> std::string {
        double value = 0.0;
        if (!isNumber(text, value)) return "'" + text + "' is not a number";
        return value >= low && value <= high ? "" : text + " is not in the range of " + possible;
      },
      range.str());
}

CLI::Option* addSeed(CLI::App& command, std::uint64_t& seed, const std::string& what) {
  return command.add_option("--seed", seed, what)->check(CLI::Validator(checkSeed, ""))->capture_default_str();
}

CLI::Option* addThreads(CLI::App& command, int& threads) {
  return command.add_option("--threads", threads, "threads, 0 = all; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->transform(CLI::Validator(limitThreads, ""))
      ->capture_default_str();
}

void addOutput(CLI::App& command, Output& output, const std::string& what) {
  command.add_option("-o,--output", output.path, what)->required();
  command.add_flag("--force", output.force, "replace an existing output");
}

void addMap(CLI::App& command, std::string& path) {
  command.add_option("map", path, "map (.gmap, or PCD of Gaussians)")->required();
}

void addJson(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "print the result as JSON");
}

}  // namespace gaussmap::app
