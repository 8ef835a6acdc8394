// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark pose-check --data DIR: how often the check of poses finds poses that mean something else. Draws
// random runs of 5 to 20 neighbouring scans from the sequences of DIR and from simulated worlds. For each run, it
// counts the false alarms with the right poses, and the alarms that name the mistake with each kind of wrong poses.
// A mistake that hardly moves the scans against each other cannot be found and is counted separately.
#include "registration/pose_check.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "clock.h"
#include "gaussmap/io/scans/file_scans.h"
#include "registration/pose_pairs.h"
#include "registration/scan_surfaces.h"
#include "simulation/simulation.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

// A mistake counts as visible if it moves two near scans against each other by this part of their radius.
constexpr double kVisible = 0.05;

struct Sequence {
  std::string name;
  std::vector<Scan> scans;
  ScanExtent extent;
};

/// The wrong poses that lead to the alarm `convention`.
struct Mistake {
  const char* name;
  PoseConvention convention;
  ScanFrame frame;     ///< what the program is told
  bool points_in_map;  ///< what the files hold
};
constexpr std::array<Mistake, 7> kMistakes = {{
    {"points in map frame", PoseConvention::NoMotion, ScanFrame::Sensor, true},
    {"--frame map, not in it", PoseConvention::SensorToMap, ScanFrame::Map, false},
    {"inverse poses", PoseConvention::Inverse, ScanFrame::Sensor, false},
    {"w first read as xyzw", PoseConvention::WFirst, ScanFrame::Sensor, false},
    {"w last read as wxyz", PoseConvention::WLast, ScanFrame::Sensor, false},
    {"camera poses", PoseConvention::Camera, ScanFrame::Sensor, false},
    {"camera points", PoseConvention::Optical, ScanFrame::Sensor, false},
}};

/// Returns the pose that a program reads if the file means `convention`.
Pose readAs(PoseConvention convention, const Pose& pose) {
  switch (convention) {
    case PoseConvention::WFirst:
      return poseAs(PoseConvention::WLast, pose);
    case PoseConvention::WLast:
      return poseAs(PoseConvention::WFirst, pose);
    case PoseConvention::Camera:
      return poseAs(PoseConvention::Optical, pose);
    case PoseConvention::Optical:
      return poseAs(PoseConvention::Camera, pose);
    case PoseConvention::Inverse:
      return pose.inverse();
    default:
      return pose;
  }
}

/// Scans of a sequence with other poses; the points can be moved into the map frame.
class Run : public Scans {
 public:
  Run(const Sequence& sequence, std::size_t first, std::size_t count, const Mistake* mistake)
      : sequence_(sequence), first_(first), count_(count), mistake_(mistake) {}

  std::size_t size() const override { return count_; }
  ScanInfo info(std::size_t index) const override {
    const Pose& pose = sequence_.scans[first_ + index].pose;
    return {std::to_string(index), mistake_ ? readAs(mistake_->convention, pose) : pose, {}};
  }
  ScanFrame frame() const override { return mistake_ ? mistake_->frame : ScanFrame::Sensor; }
  std::unique_ptr<ScanReader> open(std::size_t index) const override {
    return std::make_unique<Reader>(sequence_.scans[first_ + index], mistake_ && mistake_->points_in_map);
  }

 private:
  class Reader : public ScanReader {
   public:
    Reader(const Scan& scan, bool in_map) : scan_(scan), in_map_(in_map) {}
    std::size_t size() const override { return scan_.points.size(); }
    void read(std::size_t first, PointBlock<3>& block) const override {
      block.size = first < size() ? std::min(PointBlock<3>::kCapacity, size() - first) : 0;
      for (std::size_t i = 0; i < block.size; ++i)
        for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][i] = scan_.points[first + i](axis);
      if (in_map_) transform(scan_.pose, block);
    }

   private:
    const Scan& scan_;
    const bool in_map_;
  };
  const Sequence& sequence_;
  const std::size_t first_, count_;
  const Mistake* const mistake_;
};

Sequence sequenceOf(std::string name, std::vector<Scan> scans) {
  Sequence sequence{std::move(name), std::move(scans), {}};
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : sequence.scans[sequence.scans.size() / 2].points)
    if (isReturn(point)) points.push_back(point);
  sequence.extent.centre = medianOf(points);
  sequence.extent.radius = medianDistance(points, sequence.extent.centre);
  return sequence;
}

std::vector<Sequence> simulatedSequences() {
  std::vector<Sequence> sequences;
  const auto add = [&](const char* name, WorldName world, int scans, bool moving) {
    Simulation simulation = makeSimulation(world, {scans, moving});
    if (auto* const lidar = std::get_if<LidarOptions>(&simulation.sensor)) lidar->columns = 900;
    std::vector<Scan> all;
    for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
      SimulatedScan scan = simulateScan(simulation, i);
      all.push_back({std::move(scan.points), scan.pose});
    }
    sequences.push_back(sequenceOf(name, std::move(all)));
  };
  add("sim street", WorldName::Street, 40, false);
  add("sim street, moving", WorldName::Street, 120, true);
  add("sim avenue", WorldName::Avenue, 40, true);
  add("sim hall", WorldName::Hall, 30, false);
  add("sim corner", WorldName::Corner, 20, false);
  add("sim plan", WorldName::Plan, 60, false);
  return sequences;
}

std::vector<Sequence> realSequences(const std::filesystem::path& data) {
  std::vector<Sequence> sequences;
  for (const auto& entry : std::filesystem::directory_iterator(data)) {
    if (!std::filesystem::exists(entry.path() / "trajectory.tum")) continue;
    const FoundScans found = findScans({entry.path()});
    std::vector<Scan> scans;
    for (std::size_t i = 0; i < found.scans.size(); ++i) scans.push_back(found.scans.read(i));
    sequences.push_back(sequenceOf(entry.path().filename().string(), std::move(scans)));
  }
  std::sort(sequences.begin(), sequences.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return sequences;
}

/// Returns the largest separation, as a part of the radius, between the right and the wrong motions of two scans of the
/// run that are neighbours or at most one radius apart.
double effectOf(const Sequence& sequence, std::size_t first, std::size_t count, const Mistake& mistake) {
  double most = 0.0;
  for (std::size_t i = first; i < first + count; ++i)
    for (std::size_t j = i + 1; j < first + count; ++j) {
      const Pose &to = sequence.scans[i].pose, &from = sequence.scans[j].pose;
      if (j > i + 1 && (to.translation - from.translation).norm() > sequence.extent.radius) continue;
      const Pose right = to.inverse() * from;
      Pose wrong;
      if (mistake.points_in_map)
        wrong = to.inverse() * (to.inverse() * (from * from));  // both scans are moved twice
      else if (mistake.frame == ScanFrame::Sensor)
        wrong = readAs(mistake.convention, to).inverse() * readAs(mistake.convention, from);
      most = std::max(most, separation(right, wrong, sequence.extent) / sequence.extent.radius);
    }
  return most;
}

const char* nameOf(PoseConvention convention) {
  static const char* const names[] = {"given", "none", "inverse", "w-first", "w-last", "camera", "optical"};
  return names[std::size_t(convention)];
}

struct Counts {
  int runs = 0, invisible = 0, found = 0, named = 0, doubtful = 0;
  double least_fit = 1.0;  // share of pieces on surfaces: with the right poses, or with the named convention
};

struct Options {
  std::string data;
  int runs = 200;
  unsigned seed = 1;
  std::size_t pairs = PoseCheckOptions().pairs;
  bool verbose = false;
};

void run(const Options& options) {
  std::vector<Sequence> sequences = simulatedSequences();
  if (!options.data.empty())
    for (Sequence& sequence : realSequences(options.data)) sequences.push_back(std::move(sequence));
  std::mt19937 random(options.seed);
  std::map<std::string, std::array<Counts, kMistakes.size() + 1>> table;
  std::array<Counts, kMistakes.size() + 1> all;
  PoseCheckOptions check;
  check.pairs = options.pairs;
  double seconds = 0.0;
  for (int i = 0; i < options.runs; ++i) {
    const Sequence& sequence = sequences[std::size_t(i) % sequences.size()];
    const std::size_t count = std::min<std::size_t>(sequence.scans.size(), 5 + random() % 16);
    const std::size_t first = random() % (sequence.scans.size() - count + 1);
    for (std::size_t m = 0; m <= kMistakes.size(); ++m) {
      const Mistake* const mistake = m == 0 ? nullptr : &kMistakes[m - 1];
      Counts one;
      one.runs = 1;
      const double effect = mistake != nullptr ? effectOf(sequence, first, count, *mistake) : 0.0;
      one.invisible = mistake != nullptr && effect < kVisible;
      const double start = wallSeconds();
      const PoseCheck result = checkPoses(Run(sequence, first, count, mistake), check);
      seconds += wallSeconds() - start;
      one.doubtful = result.doubtful && !one.invisible;
      one.found = result.better.has_value() && !one.invisible;
      one.named = one.found && mistake != nullptr && *result.better == mistake->convention;
      if (options.verbose && (mistake == nullptr || (!one.invisible && !one.named))) {
        std::printf("  %s %zu+%zu %s (%.2f): %s", sequence.name.c_str(), first, count,
                    mistake ? mistake->name : "right", effect, result.better ? nameOf(*result.better) : "-");
        if (!result.duels.empty())
          for (std::size_t c = 0; c < kPoseConventions.size(); ++c) {
            const ConventionDuel& duel = result.duels[std::size_t(result.given)][c];
            if (duel.pieces > 0)
              std::printf("  %s %zu: %zu/%zu+%zu", nameOf(kPoseConventions[c]), duel.pieces, duel.first_only,
                          duel.other_only, duel.both);
          }
        std::printf("\n");
      }
      if (mistake == nullptr && !result.fits.empty()) one.least_fit = result.fits[std::size_t(result.given)].share();
      if (one.named) one.least_fit = result.fits[std::size_t(*result.better)].share();
      for (Counts* const counts : {&table[sequence.name][m], &all[m]}) {
        counts->runs += one.runs;
        counts->invisible += one.invisible;
        counts->found += one.found;
        counts->named += one.named;
        counts->doubtful += one.doubtful;
        counts->least_fit = std::min(counts->least_fit, one.least_fit);
      }
    }
  }
  std::printf("alarms in %% of the runs in which the mistake moves the scans by more than %.0f %% of their radius\n",
              100.0 * kVisible);
  std::printf("%-30s %5s %6s", "sequence", "runs", "right");
  for (const Mistake& mistake : kMistakes) std::printf(" %15.15s", mistake.name);
  std::printf("\n");
  const auto print = [](const std::string& name, const std::array<Counts, kMistakes.size() + 1>& row) {
    std::printf("%-30s %5d %6d", name.c_str(), row[0].runs, row[0].found);
    for (std::size_t m = 1; m < row.size(); ++m) {
      const int visible = row[m].runs - row[m].invisible;
      if (visible == 0)
        std::printf(" %15s", "-");
      else
        std::printf(" %5.1f (%3d/%3d)", 100.0 * row[m].named / visible, row[m].found, visible);
    }
    std::printf("\n");
  };
  for (const auto& [name, row] : table) print(name, row);
  print("all", all);
  std::printf("warnings that the scans do not fit: %d with the right poses; with mistakes that were not named:",
              all[0].doubtful);
  for (std::size_t m = 1; m < all.size(); ++m) std::printf(" %d", all[m].doubtful);
  std::printf("\n");
  std::printf("least share of pieces on surfaces: %.3f with the right poses; with the named meaning:",
              all[0].least_fit);
  for (std::size_t m = 1; m < all.size(); ++m) std::printf(" %.3f", all[m].least_fit);
  std::printf("\n");
  std::printf("%.1f ms per check\n", 1e3 * seconds / options.runs / double(kMistakes.size() + 1));
}

}  // namespace

void addPoseCheck(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App& command = *app.add_subcommand("pose-check", "how often the check of poses finds wrong poses");
  command.add_option("--data", options->data, "directory with sequences (folders with trajectory.tum)");
  command.add_option("--runs", options->runs, "number of random runs of scans");
  command.add_option("--seed", options->seed, "seed of the runs");
  command.add_option("--pairs", options->pairs, "pairs of scans per check");
  command.add_flag("--verbose", options->verbose, "print the counts of each miss");
  command.callback([options] { run(*options); });
}

}  // namespace gaussmap::benchmark
