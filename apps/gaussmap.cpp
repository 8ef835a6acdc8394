// SPDX-License-Identifier: BSD-3-Clause
// The command line: parses, runs one command, turns every error into one line on stderr and an exit code.
#include <exception>
#include <iostream>
#include <new>

#include "common.h"

int main(int argc, char** argv) {
  using namespace gaussmap::app;
  CLI::App app("Compact multi-scale Gaussian maps from range scans", "gaussmap");
  app.set_version_flag("--version", "gaussmap " GAUSSMAP_VERSION);
  app.require_subcommand(1);
  app.footer("Example: gaussmap pcd2map scans/ -o street.gmap && gaussmap info street.gmap");
  addPcd2map(app);
  addRefine(app);
  addInfo(app);
  addExport(app);
  addHausdorff(app);
  addSimulate(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::cerr << "gaussmap: " << error.what() << " (see gaussmap --help)\n";
    return 2;
  } catch (const UsageError& error) {
    std::cerr << "gaussmap: " << error.what() << '\n';
    return 2;
  } catch (const std::bad_alloc&) {
    std::cerr << "gaussmap: out of memory: take coarser cells (--resolution) or fewer scans\n";
    return 1;
  } catch (const std::exception& error) {
    std::cerr << "gaussmap: " << error.what() << '\n';
    return 1;
  }
}
