// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark papers [--data DIR] [--output docs/reproduction.md] [--scans N]: repeats the experiments of
// Yguel et al. 2009 and Leal et al. 2000 and judges their claims. Writes a page of Markdown, with plots in a folder
// beside it. DIR has the recordings carmen_intel and mulran_kaist03_21scans; without it, only simulated data are used.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "clock.h"
#include "papers/claims.h"
#include "papers/deletion.h"
#include "papers/off_line.h"
#include "papers/over_time.h"
#include "papers/report.h"
#include "papers/sequences.h"
#include "subcommands.h"

namespace gaussmap::papers {
namespace {

struct Options {
  std::string data, output = "reproduction.md";
  std::size_t scans = 0;
  int checkpoints = 10;
};

/// Tells what was done, and when.
class Progress {
 public:
  void done(const std::string& what) const {
    std::printf("%6.0f s  %s\n", benchmark::wallSeconds() - start_, what.c_str());
    std::fflush(stdout);
  }

 private:
  double start_ = benchmark::wallSeconds();
};

struct Results {
  std::vector<OverTime> over_time;
  std::vector<OffLine> off_line;
  std::vector<DeletionRow> deletion;
};

template <int D>
void runSequences(const std::vector<Sequence<D>>& sequences, const Options& options, const Progress& progress,
                  Results& results) {
  for (const Sequence<D>& sequence : sequences) {
    results.over_time.push_back(runOverTime(sequence, options.checkpoints));
    progress.done(sequence.name + ", on line");
    results.off_line.push_back(runOffLine(sequence));
    progress.done(sequence.name + ", off line");
  }
}

void run(const Options& options) {
  const Progress progress;
  Results results;
  runSequences(planarSequences(options.data, options.scans), options, progress, results);
  runSequences(sequencesInSpace(options.data, options.scans), options, progress, results);
  results.deletion = runDeletion(options.scans);
  progress.done("street with traffic");
  Report report(options.output);
  claimRefinement(results.off_line, results.over_time, report);
  report.heading(2, "Yguel, sections 4.4 and 5.3: learning and deleting");
  reportDeletion(results.deletion, report);
  report.heading(2, "Yguel, section 6: maps over time");
  for (const OverTime& one : results.over_time) reportOverTime(one, report);
  report.heading(2, "Yguel, section 6: the whole recording refined at once");
  for (const OffLine& one : results.off_line) reportOffLine(one, report);
  report.save("# The papers, rerun and judged");
  progress.done(options.output);
}

}  // namespace
}  // namespace gaussmap::papers

namespace gaussmap::benchmark {

void addPapers(CLI::App& app) {
  const auto options = std::make_shared<papers::Options>();
  CLI::App& command = *app.add_subcommand("papers", "the experiments of both papers, with verdicts");
  command.add_option("--data", options->data, "folder with carmen_intel and mulran_kaist03_21scans")
      ->check(CLI::ExistingDirectory);
  command.add_option("--output", options->output, "page to write (.md)")->capture_default_str();
  command.add_option("--scans", options->scans, "at most this many scans of each recording, 0 = all");
  command.callback([options] { papers::run(*options); });
}

}  // namespace gaussmap::benchmark
