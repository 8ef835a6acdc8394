// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <memory>

#include "common/command.h"

namespace gaussmap::app {

/// Returns the formatter of a command's help. --help shows the options of the default group and the example; --help-all
/// shows everything.
std::shared_ptr<CLI::Formatter> makeHelpFormatter(const Help& help);

}  // namespace gaussmap::app
