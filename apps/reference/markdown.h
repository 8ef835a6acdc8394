// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reference/option_tree.h"

namespace gaussmap::app {

/// The command reference as one page of Markdown (GitHub's, also that of MyST).
std::string markdownReference(const ProgramTree& tree);

}  // namespace gaussmap::app
