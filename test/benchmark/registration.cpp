// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark registration [--data DIR] [--starts 3] [--basin 10] [--json FILE]: compares the registration of a
// scan onto a scan with NDT and GICP of PCL. DIR has the directories kitti_6scans, mulran_kaist03_21scans and
// dtk_indoor_3scans; a missing directory is reported and left out. The simulated street is always measured. One thread,
// processor time. Prints tables in Markdown.
#include <pcl/console/print.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "clock.h"
#include "registration_methods.h"
#include "subcommands.h"
#include "table.h"

namespace gaussmap::benchmark {
namespace {

constexpr double kMetres = 0.05, kDegrees = 0.2;  // maximum errors of a success
constexpr Offset kNear{0.5, 1.0, false}, kBasin{5.0, 30.0, true};

struct RegistrationOptions {
  std::string data, json;
  int starts = 3, basin = 10;
  bool quick = false, alone = false, each = false;
};

struct Dataset {
  std::string name;
  std::vector<ScanPair> pairs;
  Sizes sizes;
};

/// One kind of start: the start poses per pair.
struct Starts {
  std::string name;
  std::vector<std::vector<Pose>> poses;
};

/// Returns the processor time [ms].
double now() {
  return 1e3 * processorSeconds();
}

Starts startsFrom(const Dataset& data, const std::string& name, const Offset& offset, int count) {
  Starts starts{name, {}};
  for (std::size_t pair = 0; pair < data.pairs.size(); ++pair) {
    starts.poses.emplace_back();
    for (int i = 0; i < count; ++i)
      starts.poses.back().push_back(startFrom(data.pairs[pair].reference, offset, 1000 * pair + std::uint64_t(i)));
  }
  return starts;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Score {
  int tries = 0, successes = 0;
  std::vector<double> metres, degrees;  // of all tries
  double align = 0.0;                   // [ms], all tries
};

void compare(const Dataset& data, const std::vector<Starts>& kinds, const std::vector<Method>& methods,
             const RegistrationOptions& options, Table& table) {
  std::vector<Score> own;  // scores of the first method, which is ours
  double own_prepare = 0.0;
  std::printf("| %s, %zu pair%s | start | success | median off | prepare | align | both [ms] |\n", data.name.c_str(),
              data.pairs.size(), data.pairs.size() == 1 ? "" : "s");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Method& method : methods) {
    double prepare = 0.0;
    std::vector<Score> scores(kinds.size());
    for (std::size_t i = 0; i < data.pairs.size(); ++i) {
      const double before = now();
      const auto prepared = method.prepare(data.pairs[i]);
      prepare += (now() - before) / double(data.pairs.size());
      for (std::size_t kind = 0; kind < kinds.size(); ++kind)
        for (const Pose& start : kinds[kind].poses[i]) {
          const double started = now();
          const PoseError error = errorOf(prepared->align(start), data.pairs[i].reference);
          Score& score = scores[kind];
          score.align += now() - started;
          score.successes += error.metres <= kMetres && error.degrees <= kDegrees;
          ++score.tries;
          score.metres.push_back(error.metres);
          score.degrees.push_back(error.degrees);
          if (options.each)
            std::fprintf(stderr, "%s %s %s %s: %.3f m %.3f deg\n", method.name.c_str(), data.name.c_str(),
                         data.pairs[i].name.c_str(), kinds[kind].name.c_str(), error.metres, error.degrees);
        }
    }
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const Score& score = scores[kind];
      const double align = score.align / score.tries;
      std::printf("| %s | %s | %d of %d | %.3f m, %.2f deg | %.0f | %.0f | %.0f |\n", method.name.c_str(),
                  kinds[kind].name.c_str(), score.successes, score.tries, median(score.metres), median(score.degrees),
                  prepare, align, prepare + align);
      std::fflush(stdout);
      if (own.empty()) continue;
      const auto of = [](const Score& one) {
        return std::to_string(one.successes) + " of " + std::to_string(one.tries);
      };
      table.rows.push_back(Row{"registration (" + of(own[kind]) + " found)", data.name + ", " + kinds[kind].name, 1,
                               1e-3 * (own_prepare + own[kind].align / own[kind].tries), 0.0,
                               method.name + " (" + of(score) + " found)", 1e-3 * (prepare + align), 0.0});
    }
    if (own.empty()) {
      own = scores;
      own_prepare = prepare;
    }
  }
  std::printf("\n");
}

void run(const RegistrationOptions& options) {
  std::vector<Dataset> all{{"simulated street", streetPairs(1, options.quick ? 1 : 4), kOutdoor}};
  if (!options.data.empty()) {
    const std::filesystem::path root = options.data;
    all.push_back({"kitti_6scans", filePairs(root / "kitti_6scans", 5, 1), kOutdoor});
    all.push_back({"mulran_kaist03_21scans", filePairs(root / "mulran_kaist03_21scans", 1, 20), kOutdoor});
    all.push_back({"dtk_indoor_3scans", filePairs(root / "dtk_indoor_3scans", 1, 2), kIndoor});
  }
  Table table;
  for (const Dataset& data : all) {
    if (data.pairs.empty()) {
      std::printf("%s: not in %s\n\n", data.name.c_str(), options.data.c_str());
      continue;
    }
    std::vector<Method> methods{gaussianMap(data.sizes)};
    if (!options.alone) methods.insert(methods.end(), {pclNdt(data.sizes), pclGicp(data.sizes)});
    std::vector<Starts> kinds{startsFrom(data, "0.5 m, 1 deg", kNear, options.starts)};
    if (data.name.rfind("kitti", 0) == 0) kinds.push_back({"identity", {{Pose()}}});
    if (options.basin > 0) kinds.push_back(startsFrom(data, "up to 5 m, 30 deg", kBasin, options.basin));
    compare(data, kinds, methods, options, table);
  }
  if (!options.json.empty()) writeJson(options.json, table);
}

}  // namespace

void addRegistration(CLI::App& app) {
  const auto options = std::make_shared<RegistrationOptions>();
  CLI::App& command = *app.add_subcommand("registration", "registration of scans, beside NDT and GICP of PCL");
  command.add_option("--data", options->data, "folder of the datasets");
  command.add_option("--starts", options->starts, "near starts per pair")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--basin", options->basin, "far starts per pair")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--json", options->json, "write the rows for machines");
  command.add_flag("--quick", options->quick, "one pair of the street");
  command.add_flag("--alone", options->alone, "without the methods of PCL");
  command.add_flag("--each", options->each, "print every try on stderr");
  command.callback([options] {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
    run(*options);
  });
}

}  // namespace gaussmap::benchmark
