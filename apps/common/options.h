// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "common/help.h"
#include "common/usage.h"

namespace gaussmap::app {

/// A number from `low` to `high`; unlike CLI::Range it refuses NaN.
CLI::Validator numberBetween(double low, double high);
/// Adds --seed, a whole number from 0 on.
CLI::Option* addSeed(CLI::App& command, std::uint64_t& seed, const std::string& what);
/// Adds --threads (0 = all).
CLI::Option* addThreads(CLI::App& command, int& threads);
/// Adds -o/--output (required) and --force.
void addOutput(CLI::App& command, Output& output, const std::string& what);
/// Adds the positional argument of a map.
void addMap(CLI::App& command, std::string& path);
/// Adds --json.
void addJson(CLI::App& command, bool& json);

}  // namespace gaussmap::app
