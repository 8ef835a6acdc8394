// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark SUBCOMMAND: runs one benchmark. test/benchmark/RESULTS.md has the results.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "subcommands.h"

int main(int argc, char** argv) try {
  using namespace gaussmap::benchmark;
  CLI::App app("Benchmarks of gaussmap");
  app.require_subcommand(1);
#ifdef GAUSSMAP_BENCHMARK_PCL
  addTable(app);
  addGrowth(app);
  addFormats(app);
  addRegistration(app);
  addNormals(app);
  addFilters(app);
  addSearch(app);
#endif
  addRefinementTable(app);
  addRefinementSpeed(app);
  addSegments(app);
  addMovingPoints(app);
  addFinishedSize(app);
#ifdef GAUSSMAP_BENCHMARK_VIEWER
  addFrameTimes(app);
#endif
  addDistances(app);
  addReference(app);
  addWideScans(app);
  addBoxLoad(app);
  addPoseCheck(app);
  addPlanar(app);
  addPapers(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;  // help or wrong usage
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "gaussmap_benchmark: %s\n", error.what());
  return 1;
}
