// SPDX-License-Identifier: BSD-3-Clause
// gaussmap view: starts the separate program gaussmap-view, so that no other command has to load VTK.
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

#include "commands/commands.h"
#include "commands/view_options.h"
#include "common/command.h"

namespace gaussmap::app {
namespace {

/// Does not return unless it throws.
void startViewer(const std::vector<std::string>& arguments) {
  const std::filesystem::path viewer = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "gaussmap-view";
  if (access(viewer.c_str(), X_OK) != 0)
    throw std::runtime_error(
        viewer.string() +
        ": the viewer does not exist; build it with -DGAUSSMAP_BUILD_VIEWER=ON or use gaussmap draw for pictures");
  std::vector<std::string> words = {viewer.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(viewer.c_str(), argv.data());
  throw std::runtime_error(viewer.string() + ": cannot be started");
}

}  // namespace

void addView(CLI::App& app) {
  Command(app, "view", {kViewSummary, "", ""}).passOn(startViewer);
}

}  // namespace gaussmap::app
