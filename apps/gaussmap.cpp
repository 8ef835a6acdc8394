// SPDX-License-Identifier: BSD-3-Clause
// The command line: parses the options, runs one command, and turns every error into one line on stderr and an exit
// code.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "commands/commands.h"
#include "common/signals.h"
#include "common/usage.h"
#include "gaussmap/version.h"

namespace gaussmap::app {

namespace {

/// Returns an error of CLI11 in plain words. The text ends with the help command to run next.
std::string explain(const CLI::ParseError& error, const CLI::App& app) {
  const auto used = app.get_subcommands();
  if (used.empty()) {
    std::string commands;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App* one) { return !one->get_group().empty(); }))
      commands += (commands.empty() ? "" : ", ") + command->get_name();
    const std::vector<std::string> words = app.remaining();
    return (words.empty() ? "no command given" : "'" + words.front() + "' is not a command") + ": use one of " +
           commands + " (see gaussmap --help)";
  }
  std::string text = error.what();
  const std::string unreadable = "Could not convert: ";
  if (text.compare(0, unreadable.size(), unreadable) == 0)
    text = text.substr(unreadable.size()) + " is not a number that this option accepts";
  return text + " (see gaussmap " + used.front()->get_name() + " --help)";
}

/// Prints one line on stderr. Control characters (file names can contain them) become '?'. Returns the exit code.
int complain(std::string text, int code) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = '?';
  std::cerr << "gaussmap: " << text << '\n';
  return code;
}

}  // namespace
}  // namespace gaussmap::app

int main(int argc, char** argv) {
  using namespace gaussmap::app;
  handleSignals("gaussmap");
  CLI::App app("Compact multi-scale Gaussian maps from range scans", "gaussmap");
  app.set_version_flag("--version", "gaussmap " GAUSSMAP_VERSION);
  app.set_help_all_flag("--help-all", "show all options and explanations");
  app.require_subcommand(1);
  app.footer("Example: gaussmap pcd2map scans/ -o street.gmap && gaussmap info street.gmap");
  addPcd2map(app);
  addScans(app);
  addRefine(app);
  addCompress(app);
  addRegister(app);
  addFinish(app);
  addTiles(app);
  addSimplify(app);
  addMerge(app);
  addTransform(app);
  addCrop(app);
  addDiff(app);
  addClean(app);
  addRestore(app);
  addInfo(app);
  addExport(app);
  addHausdorff(app);
  addSimulate(app);
  addDraw(app);
  addSegments(app);
  addView(app);
  addCompletion(app);
  addReference(app);
  try {
    app.parse(argc, argv);
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0) throw std::runtime_error("cannot write to standard output");
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return complain(explain(error, app), 2);
  } catch (const UsageError& error) {
    return complain(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return complain("out of memory: use coarser cells (--resolution) or fewer scans", 1);
  } catch (const std::exception& error) {
    const std::string what = error.what();
    const bool no_thread = what.compare(0, 14, "pthread_create") == 0;  // the message of TBB
    return complain(what + (no_thread ? ": cannot start a thread; try --threads 1" : ""), 1);
  }
}
