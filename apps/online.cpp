// SPDX-License-Identifier: BSD-3-Clause
#include "online.h"

#include <locale>
#include <map>
#include <set>
#include <sstream>

#include "io/files/atomic_file.h"
#include "io/pcd/removed_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const std::map<std::string, LearningRate> kRates = {{"sample-mean", LearningRate::SampleMean},
                                                    {"occupancy", LearningRate::Occupancy}};
const std::map<std::string, OccupancySamples> kSamples = {{"mean", OccupancySamples::Mean},
                                                          {"random", OccupancySamples::Random}};

/// One line a scan.
class StatisticsTable {
 public:
  explicit StatisticsTable(int scales) : scales_(static_cast<std::size_t>(scales)) {
    text_.imbue(std::locale::classic());
    text_ << "scan,file,points,cells_touched,cells_new,cells_tested,cells_visited,added,deleted,update_s,image_s,"
             "look_back_s,occupancy_s,forget_s,refine_s";
    for (int s = 1; s < scales; ++s) text_ << ",error_" << s;
    text_ << '\n';
  }

  void add(std::size_t scan, const std::filesystem::path& path, const OnlineStatistics& s) {
    std::string name = path.filename().string();
    for (std::size_t i = name.find('"'); i != std::string::npos; i = name.find('"', i + 2)) name.insert(i, 1, '"');
    text_ << scan << ",\"" << name << "\"," << s.points.accepted << ',' << s.cells_touched << ',' << s.cells_new << ','
          << s.cells_tested << ',' << s.cells_visited << ',' << s.added << ',' << s.deleted << ',' << s.update_time
          << ',' << s.image_time << ',' << s.look_back_time << ',' << s.occupancy_time << ',' << s.forget_time << ','
          << s.refine_time;
    for (std::size_t scale = 1; scale < scales_; ++scale) {
      text_ << ',';
      if (scale < s.errors.size()) text_ << s.errors[scale];  // else nothing was refined
    }
    text_ << '\n';
  }

  void write(const std::filesystem::path& path) const {
    const std::string text = text_.str();
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.commit();
  }

 private:
  std::size_t scales_;
  std::ostringstream text_;
};

}  // namespace

void addOnlineOptions(CLI::App& command, OnlineInput& input) {
  CLI::Option* const online = command.add_flag(
      "--online", input.on, "take in scan by scan: occupancy from range images, what has moved is forgotten");
  const std::string group = "With --online";
  const auto option = [&](CLI::Option* made) { return made->needs(online)->group(group); };
  OnlineOptions& options = input.options;
  option(command.add_option("--learning-rate", options.learning_rate, "how a point moves its cluster"))
      ->transform(CLI::CheckedTransformer(kRates, CLI::ignore_case))
      ->default_str("sample-mean");
  option(command.add_option("--occupancy-every", options.occupancy_every,
                            "scans between two looks at what is seen through"))
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  option(command.add_option("--occupancy-samples", options.samples, "what of a cluster is looked at"))
      ->transform(CLI::CheckedTransformer(kSamples, CLI::ignore_case))
      ->default_str("mean");
  option(command.add_option("--look-back", options.look_back, "range images asked about new cells"))
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  option(command.add_option("--no-return-is-free", input.no_return_is_free,
                            "take directions without a return for free space up to this range [m]"))
      ->check(numberBetween(1e-3, 1e6));
  option(command.add_option("--max-ranges", options.max_ranges,
                            "per scale, finest first: cells farther away are not looked at [m]"))
      ->delimiter(',')
      ->check(numberBetween(1e-3, 1e9));
  option(command.add_flag("--keep", input.keep, "forget nothing"));
  option(command.add_option("--refine-every", options.refine_every, "scans between two refinements, 0 = never"))
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  option(
      command.add_option("--refine-cells", options.refine_cells,
                         "most clusters added to a scale at a time, 0 = as many as the budget allows (the paper: 4)"))
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  option(command.add_option("--stats", input.stats, "write what each scan did and how long it took (.csv)"));
  option(command.add_option("--removed", input.removed, "write what was forgotten, with the evidence (.pcd)"));
}

void checkOnline(const OnlineInput& input, const BudgetInput& budget, const Output& map,
                 const std::vector<std::filesystem::path>& inputs) {
  if (!input.on) return;
  if (!budget.max_gaussians.empty() || !budget.max_bytes.empty() || budget.max_error > 0.0)
    throw UsageError("--online takes --budget only: refine the map afterwards for another limit");
  if (budget.cost) throw UsageError("--online takes no --cost");
  if (budget.refine.seed != RefineOptions().seed) throw UsageError("--online takes no --seed");
  std::set<std::filesystem::path> taken = {std::filesystem::weakly_canonical(map.path)};
  for (const std::string& file : {input.stats, input.removed}) {
    if (file.empty()) continue;
    if (!taken.insert(std::filesystem::weakly_canonical(file)).second)
      throw UsageError(file + " is another output of this command already: take another name");
    checkOutput({file, map.force}, inputs);
  }
}

OnlineResult mapOnline(const Scans& scans, const OnlineInput& input, const MapOptions& map,
                       const AccumulateOptions& reading, const BudgetInput& budget) {
  OnlineOptions options = input.options;
  options.map = map;
  options.max_range = reading.max_range;
  options.threads = reading.threads;
  options.budget = budget.budget;
  options.method = budget.method == "insert" ? RefineMethod::Insert : RefineMethod::Agglomerate;
  options.forget = !input.keep;
  if (input.no_return_is_free > 0.0) options.no_return_is_free = input.no_return_is_free;
  std::vector<RemovedCluster<3>> removed;
  OnlineMapper<3>::Removed note;
  if (!input.removed.empty()) note = [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); };
  OnlineMapper<3> mapper(options, note);

  OnlineResult result;
  StatisticsTable table(map.scales);
  ProgressBar bar;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanInfo info = scans.info(i);
    OnlineStatistics statistics;
    try {
      statistics = mapper.add(scans.read(i));
    } catch (const std::out_of_range& error) {
      throw std::out_of_range(info.name + ": " + error.what());
    }
    result.counts += statistics.points;
    table.add(i, info.name, statistics);
    result.deleted += statistics.deleted;
    bar.show({i + 1, scans.size(), result.counts.accepted, 0});
  }
  if (result.counts.accepted == 0) return result;  // an error of the caller's: no file is written
  result.map = mapper.map();
  if (!input.stats.empty()) table.write(input.stats);
  if (!input.removed.empty()) writeRemoved(input.removed, removed);
  return result;
}

}  // namespace gaussmap::app
