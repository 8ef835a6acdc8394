// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reference/option_tree.h"

namespace gaussmap::app {

/// Page gaussmap.1, in the macros of mdoc(7). `version` is printed at the foot; `date`, such as "May 4, 2026", too.
std::string programManPage(const ProgramTree& tree, const std::string& version, const std::string& date);
/// Page gaussmap-COMMAND.1.
std::string commandManPage(const ProgramTree& tree, const CommandEntry& command, const std::string& version,
                           const std::string& date);

}  // namespace gaussmap::app
