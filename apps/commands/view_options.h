// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "commands/scan_input.h"
#include "common/usage.h"
#include "viewer/viewer.h"

namespace CLI {
class App;
}

// The options of gaussmap-view, which `gaussmap view` starts. They need no VTK: the reference shows them in every
// build.
namespace gaussmap::app {

struct ViewCommand {
  std::string map;
  ScanInput cloud;
  std::optional<int> scale;
  bool leaves = false;
  std::string colour;  // empty: the default
  std::string mesh;
  std::optional<double> span;
  std::string up = "z", from, size = "1200x800";
  std::vector<double> at;
  Output png;
  ViewOptions view;
};

inline const std::map<std::string, Vector<3>> kUpAxes = {{"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}},
                                                         {"-x", {-1, 0, 0}}, {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};

inline constexpr const char* kViewSummary = "Show a map in a window, or save a picture (--png)";
inline constexpr const char* kViewHelpAll = "show all options and the keys";

/// Adds the options to a program that has no commands. `options` must live as long as the program.
void addViewOptions(CLI::App& program, ViewCommand& options);

}  // namespace gaussmap::app
