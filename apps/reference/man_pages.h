// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reference/option_tree.h"

namespace gaussmap::app {

/// Returns the page gaussmap.1 in the macros of mdoc(7). Its foot shows `version` and `date`, such as "May 4, 2026".
std::string programManPage(const ProgramTree& tree, const std::string& version, const std::string& date);
/// Returns the page gaussmap-COMMAND.1.
std::string commandManPage(const ProgramTree& tree, const CommandEntry& command, const std::string& version,
                           const std::string& date);

}  // namespace gaussmap::app
