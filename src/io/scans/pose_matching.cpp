// SPDX-License-Identifier: BSD-3-Clause
// Which pose belongs to which scan.
#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "gaussmap/io/scans/pose_file.h"
#include "io/files/text.h"
#include "io/scans/name_numbers.h"
#include "io/scans/pose_times.h"
#include "io/scans/scan_names.h"

namespace gaussmap {
using namespace detail;

namespace {

/// What the scans and the poses can be matched by.
struct ScanNumbers {
  std::vector<std::uint64_t> indices;  // empty, or one per scan
  std::vector<Instant> times;          // empty, or one per scan
  std::vector<Decimal> written;        // the times as written in the names; empty if the scans bring their own
  bool dates = false;                  // the times are dates in names
};

ScanNumbers numbersOfScans(const std::vector<ScanKey>& scans) {
  std::vector<std::string> names;
  names.reserve(scans.size());
  for (const ScanKey& scan : scans) names.push_back(scan.name);
  NameNumbers found = numbersIn(names);
  ScanNumbers numbers;
  numbers.indices = std::move(found.indices);
  if (!scans.empty() && std::all_of(scans.begin(), scans.end(), [](const ScanKey& scan) { return scan.time; })) {
    for (const ScanKey& scan : scans) numbers.times.push_back(*scan.time);
  } else {
    numbers.times = timesIn(found.times, unitByMagnitude(largestOf(found.times)));
    if (!numbers.times.empty()) numbers.written = std::move(found.times), numbers.dates = found.dates;
  }
  return numbers;
}

template <typename Test>
bool allEntries(const PoseFile& file, const Test& test) {
  return std::all_of(file.entries.begin(), file.entries.end(), test);
}

bool hasTimes(const PoseFile& file) {
  return allEntries(file, [](const PoseFile::Entry& entry) { return entry.time.has_value(); });
}

bool hasIndices(const PoseFile& file) {
  return allEntries(file, [](const PoseFile::Entry& entry) { return entry.index.has_value(); });
}

void miss(MatchedPoses& matched, std::size_t scan, const std::string& reason) {
  matched.missing.push_back({scan, reason});
}

void take(MatchedPoses& matched, std::size_t scan, const PoseFile::Entry& entry) {
  matched.poses[scan] = entry.pose;
  if (!entry.pose) miss(matched, scan, "line " + std::to_string(entry.line) + " has no pose (NaN)");
}

std::string fileNameOf(const std::string& name) {
  return std::filesystem::path(name).filename().string();
}

/// Entries by name: with the folder, with the ending, without it, and without the ending of another kind of file.
class EntriesByName {
 public:
  explicit EntriesByName(const PoseFile& file) {
    for (const PoseFile::Entry& entry : file.entries) {
      by_folder_.emplace(folderAndFileName(entry.name), &entry);
      const auto [place, is_new] = exact_.emplace(fileNameOf(entry.name), &entry);
      if (!is_new) place->second = nullptr;  // only the folders tell these entries apart
    }
    for (const PoseFile::Entry& entry : file.entries) {
      const auto [other, is_new] = plain_.emplace(withoutEndings(fileNameOf(entry.name)), &entry);
      if (!is_new) other->second = nullptr;  // not clear
    }
  }
  /// A scan can be named by its folder and its file, by its file, or by its folder (000000/cloud.pcd).
  const PoseFile::Entry* find(const std::string& scan) const {
    const std::filesystem::path path(scan), name = path.filename();
    if (const auto found = by_folder_.find(folderAndFileName(path)); found != by_folder_.end()) return found->second;
    for (const std::filesystem::path& one :
         {name, name.stem(), std::filesystem::path(withoutEndings(name.string())), path.parent_path().filename()})
      if (const auto found = exact_.find(one.string()); found != exact_.end() && found->second) return found->second;
    const auto found = plain_.find(withoutEndings(name.string()));
    return found != plain_.end() ? found->second : nullptr;
  }

 private:
  std::unordered_map<std::string, const PoseFile::Entry*> by_folder_, exact_, plain_;
};

void matchByName(const PoseFile& file, const std::vector<ScanKey>& scans, MatchedPoses& matched) {
  const EntriesByName entries(file);
  std::unordered_map<const PoseFile::Entry*, std::string> users;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const PoseFile::Entry* const entry = entries.find(scans[i].name);
    if (!entry) {
      miss(matched, i, "its name is not in the file");
      continue;
    }
    const auto [user, is_new] = users.emplace(entry, scans[i].name);
    if (!is_new && user->second != scans[i].name)
      throw FileError(file.path, "line " + std::to_string(entry->line) + ": " + quote(entry->name) + " names both " +
                                     user->second + " and " + scans[i].name);
    take(matched, i, *entry);
  }
  matched.how = "matched by name";
}

/// The entries by index, or by the number of the line (counted from 0) if they have none.
class EntriesByIndex {
 public:
  explicit EntriesByIndex(const PoseFile& file) : file_(file), by_line_(!hasIndices(file)) {
    for (std::size_t i = 0; i < file.entries.size(); ++i)
      if (!by_line_ && !entries_.emplace(*file.entries[i].index, i).second) twice_.emplace(*file.entries[i].index, i);
  }
  bool byLine() const { return by_line_; }

  const PoseFile::Entry* find(std::uint64_t index) const {
    if (by_line_) return index < file_.entries.size() ? &file_.entries[index] : nullptr;
    const auto found = entries_.find(index);
    if (found == entries_.end()) return nullptr;
    const PoseFile::Entry& entry = file_.entries[found->second];
    if (const auto again = twice_.find(index); again != twice_.end())
      throw FileError(file_.path, "line " + std::to_string(file_.entries[again->second].line) + ": index " +
                                      std::to_string(index) + " already has a pose in line " +
                                      std::to_string(entry.line));
    return &entry;
  }
  /// The lowest and the highest index.
  std::pair<std::uint64_t, std::uint64_t> range() const {
    std::pair<std::uint64_t, std::uint64_t> range(std::numeric_limits<std::uint64_t>::max(), 0);
    for (const auto& [index, entry] : entries_) range = {std::min(range.first, index), std::max(range.second, index)};
    return range;
  }
  bool hasAll(const std::vector<std::uint64_t>& indices) const {
    return std::all_of(indices.begin(), indices.end(), [this](std::uint64_t index) { return find(index) != nullptr; });
  }

 private:
  const PoseFile& file_;
  bool by_line_;
  std::unordered_map<std::uint64_t, std::size_t> entries_, twice_;
};

void matchByIndex(const PoseFile& file, const std::vector<ScanKey>& scans, const ScanNumbers& numbers,
                  MatchedPoses& matched) {
  if (numbers.indices.empty() && !scans.empty())
    throw FileError(file.path, "the names of the scans have no numbers, for example " + quote(scans.front().name));
  const EntriesByIndex entries(file);
  const auto [lowest, highest] = entries.range();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::uint64_t index = numbers.indices[i];
    if (const PoseFile::Entry* const entry = entries.find(index))
      take(matched, i, *entry);
    else
      miss(matched, i,
           entries.byLine()
               ? "the file has only " + std::to_string(file.entries.size()) + " poses"
               : "no index " + std::to_string(index) +
                     (index < lowest ? "; the indices of the file start at " + std::to_string(lowest) : ""));
  }
  matched.how = entries.byLine() ? "matched by the number in the name of the scan; number 0 is the first pose"
                                 : "matched by index, the number in the name of the scan";
  if (!entries.byLine())
    matched.how += " (the file has indices " + std::to_string(lowest) + " to " + std::to_string(highest) + ")";
}

/// Returns the entries in the order of their keys. `name`: of the keys, for messages. `sort`: false keeps the order of
/// the file, with a warning if it is another one.
template <typename KeyOf>
std::vector<std::size_t> orderOfKeys(const PoseFile& file, bool sort, const std::string& name, const KeyOf& keyOf,
                                     MatchedPoses& matched) {
  std::vector<std::size_t> order(file.entries.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto isLess = [&](std::size_t a, std::size_t b) { return keyOf(file.entries[a]) < keyOf(file.entries[b]); };
  const auto wrong = std::is_sorted_until(order.begin(), order.end(), isLess);
  if (wrong == order.end()) return order;
  const std::string where = file.path.string() + ": the lines are not in the order of their " + name + " (line " +
                            std::to_string(file.entries[*wrong].line) + ")";
  if (!sort) {
    matched.warnings.push_back(where + ", but they are matched in the order of the file");
    return order;
  }
  std::stable_sort(order.begin(), order.end(), isLess);
  for (std::size_t i = 1; i < order.size(); ++i)
    if (!isLess(order[i - 1], order[i])) {
      std::string fault = "lines " + std::to_string(file.entries[order[i - 1]].line) + " and " +
                          std::to_string(file.entries[order[i]].line) + " have equal ";
      fault.append(name).append(", and the lines are not in the order of their ").append(name);
      throw FileError(file.path, fault.append(", so they cannot be matched by order"));
    }
  matched.warnings.push_back(where + ", so they are sorted before they are matched by order");
  matched.how = "sorted by " + name + " and ";
  return order;
}

/// Returns the entries in the order of their times or indices, if all have one and `sort` is set; otherwise in the
/// order of the file.
std::vector<std::size_t> orderOfEntries(const PoseFile& file, bool sort, MatchedPoses& matched) {
  if (hasTimes(file))
    return orderOfKeys(
        file, sort, "times", [](const PoseFile::Entry& entry) { return *entry.time; }, matched);
  if (hasIndices(file))
    return orderOfKeys(
        file, sort, "indices", [](const PoseFile::Entry& entry) { return *entry.index; }, matched);
  std::vector<std::size_t> order(file.entries.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  return order;
}

/// `sort`: false keeps the order of the file.
void matchByOrder(const PoseFile& file, const std::vector<ScanKey>& scans, const ScanNumbers& numbers, bool sort,
                  MatchedPoses& matched) {
  if (file.entries.size() != scans.size()) {
    std::string why;
    if (hasTimes(file) && numbers.times.empty() && !scans.empty())
      why = "the names of the scans have no times, for example " + quote(scans.front().name) + ". ";
    else if (numbers.indices.empty() && scans.size() > 1)
      why = "the names of the scans have no number in common, for example " + quote(scans[0].name) + " and " +
            quote(scans[1].name) + ". ";
    throw FileError(file.path, std::to_string(file.entries.size()) + " poses for " + std::to_string(scans.size()) +
                                   (scans.size() == 1 ? " scan: " : " scans: ") + why +
                                   "Give one line per scan in the order of the scans, start each line with the name of "
                                   "its scan, or use --match-poses index if the number in the name of a scan is its "
                                   "line number, counted from 0");
  }
  const std::vector<std::size_t> order = orderOfEntries(file, sort, matched);
  for (std::size_t i = 0; i < scans.size(); ++i) take(matched, i, file.entries[order[i]]);
  matched.how += "matched by order";
}

void matchByTime(const PoseFile& file, const std::vector<ScanKey>& scans, const ScanNumbers& numbers,
                 const PoseMatching& options, MatchedPoses& matched) {
  if (!hasTimes(file)) throw FileError(file.path, "the file has no times");
  if (numbers.times.empty() && !scans.empty())
    throw FileError(file.path, "the names of the scans have no times, for example " + quote(scans.front().name));
  const PoseTimes poses(file);
  std::vector<Instant> times = numbers.times;
  std::string unit;
  if (!numbers.written.empty()) {
    const TimeUnit chosen = poses.unitOf(numbers.written);
    times = timesIn(numbers.written, chosen);
    unit = ", times in names in " + unitName(chosen);
  }
  poses.match(times, scans, options, matched);
  if (numbers.dates) unit = "; dates in names are read as UTC";
  if (matched.missing.size() < times.size() || numbers.dates) matched.how += unit;
}

PoseMatch chooseMatch(const PoseFile& file, const std::vector<ScanKey>& scans, const ScanNumbers& numbers) {
  if (file.by_name) return PoseMatch::Name;
  if (hasTimes(file) && !numbers.times.empty()) return PoseMatch::Time;
  if (numbers.indices.empty() || (hasTimes(file) && !hasIndices(file))) return PoseMatch::Order;
  const EntriesByIndex entries(file);
  // Without indices, the numbers of the scans can be those of the lines. Ids behind the poses may count from 1.
  const bool may_be_order = entries.byLine() || file.indices_may_be_ids;
  if (may_be_order && !entries.hasAll(numbers.indices) && file.entries.size() == scans.size()) return PoseMatch::Order;
  return PoseMatch::Index;
}

}  // namespace

MatchedPoses matchPoses(const PoseFile& file, const std::vector<ScanKey>& scans, const PoseMatching& options) {
  MatchedPoses matched;
  matched.poses.resize(scans.size());
  matched.warnings = file.warnings;
  const ScanNumbers numbers = numbersOfScans(scans);
  matched.match = options.match == PoseMatch::Automatic ? chooseMatch(file, scans, numbers) : options.match;
  switch (matched.match) {
    case PoseMatch::Name:
      matchByName(file, scans, matched);
      break;
    case PoseMatch::Index:
      matchByIndex(file, scans, numbers, matched);
      break;
    case PoseMatch::Time:
      matchByTime(file, scans, numbers, options, matched);
      break;
    default:
      matchByOrder(file, scans, numbers, options.match == PoseMatch::Automatic, matched);
  }
  return matched;
}

std::vector<Pose> posesForScans(const PoseFile& file, const std::vector<std::filesystem::path>& scans) {
  std::vector<ScanKey> keys;
  keys.reserve(scans.size());
  for (const std::filesystem::path& scan : scans) keys.push_back({scan.string(), std::nullopt});
  const EntriesByName entries(file);
  const bool all_named =
      std::all_of(keys.begin(), keys.end(), [&](const ScanKey& key) { return entries.find(key.name) != nullptr; });
  PoseMatching options;
  options.match = file.by_name || all_named ? PoseMatch::Name : PoseMatch::Order;
  const MatchedPoses matched = matchPoses(file, keys, options);
  if (!matched.missing.empty())
    throw FileError(file.path, keys[matched.missing[0].scan].name + " has no pose: " + matched.missing[0].reason);
  std::vector<Pose> poses;
  poses.reserve(scans.size());
  for (const std::optional<Pose>& pose : matched.poses) poses.push_back(*pose);
  return poses;
}

}  // namespace gaussmap
