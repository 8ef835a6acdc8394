// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reference/option_tree.h"

namespace gaussmap::app {

/// Returns the command reference as one page of Markdown, for GitHub and MyST.
std::string markdownReference(const ProgramTree& tree);

}  // namespace gaussmap::app
