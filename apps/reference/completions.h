// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reference/option_tree.h"

namespace gaussmap::app {

// Scripts that complete commands, options, choices and file names. They work alone, also without the package
// bash-completion.
std::string bashCompletion(const ProgramTree& tree);
std::string zshCompletion(const ProgramTree& tree);
std::string fishCompletion(const ProgramTree& tree);

}  // namespace gaussmap::app
