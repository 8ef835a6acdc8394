// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/command.h"

namespace gaussmap::app {

/// Returns the formatter of a command's help. --help shows the options of the default group and the example; --help-all
/// shows everything.
std::shared_ptr<CLI::Formatter> makeHelpFormatter(const Help& help);

/// The group of the options that --help shows: the default group of CLI11.
inline constexpr const char* kCommonGroup = "Options";

/// What a command says about itself; the summary alone if its help has another formatter.
Help helpOf(const CLI::App& app);
/// What the help calls the value of an option: "FLOAT"; empty for a flag. CLI11 adds what its validators say.
std::string valueNameOf(const CLI::Option& option);
/// The words of which the value is one; empty if there is no such list.
std::vector<std::string> choicesOf(const CLI::Option& option);

}  // namespace gaussmap::app
