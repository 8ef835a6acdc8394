// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace gaussmap::app {

/// What a command says about itself.
struct Help {
  std::string summary;  ///< one line, also in the list of commands
  std::string example;  ///< one command line
  std::string details;  ///< paragraphs that only --help-all shows
};

/// Adds a command. Its --help shows the options of the default group and the example, its --help-all everything.
CLI::App* addCommand(CLI::App& app, const std::string& name, const Help& help);
/// The same for a program without commands.
void setHelp(CLI::App& app, const Help& help);

/// Shows an option with --help-all only.
CLI::Option* rare(CLI::Option* option);

}  // namespace gaussmap::app
