// SPDX-License-Identifier: BSD-3-Clause
#include "commands/register/guesses.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include "common/command.h"
#include "core/same_pose.h"
#include "io/scans/name_numbers.h"
#include "io/scans/scan_names.h"

namespace gaussmap::app {
namespace {

/// Returns the usable poses of the files. A map in place of a scan starts at its present place.
std::vector<std::optional<Pose>> posesInFiles(const std::vector<Subject>& subjects, bool guessed) {
  std::vector<std::optional<Pose>> poses(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    if (!subjects[i].pose) continue;
    const std::string fault = poseFault(*subjects[i].pose);
    if (fault.empty()) poses[i] = normalised(*subjects[i].pose);
    if (i == 0 && !guessed && !fault.empty())
      throw FileError(subjects[i].path, "its pose cannot be the first guess: " + fault + "; use --guess");
  }
  return poses;
}

/// Forgets poses that nobody set: the identity of several scans, or one pose of all scans that have a pose. The first
/// of them keeps the latter, because the search has to start somewhere.
void dropUnset(std::vector<std::optional<Pose>>& poses, const std::vector<Subject>& subjects) {
  if (poses.size() < 2) return;
  std::size_t at_identity = 0, first = poses.size();
  bool all_same = true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i]) continue;
    first = std::min(first, i);
    at_identity += detail::samePose(*poses[i], Pose());
    all_same = all_same && detail::samePose(*poses[i], *poses[first]);
  }
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!subjects[i].is_map && poses[i] &&
        ((all_same && i > first) || (!all_same && at_identity > 1 && detail::samePose(*poses[i], Pose()))))
      poses[i].reset();
}

}  // namespace

RegisterGuesses::RegisterGuesses(const std::vector<Subject>& subjects, const FindScansOptions& options,
                                 const std::vector<double>& guess)
    : subjects_(subjects) {
  if (!guess.empty()) {
    const Pose given = {{guess[0], guess[1], guess[2]}, Pose::Rotation(guess[6], guess[3], guess[4], guess[5])};
    if (const std::string fault = poseFault(given); !fault.empty()) throw UsageError("--guess: " + fault);
    guess_ = normalised(given);
    own_first_ = false;
  }
  own_.resize(subjects.size());
  if (options.poses.empty()) {
    own_ = posesInFiles(subjects, guess_.has_value());
    dropUnset(own_, subjects);
  }
  std::vector<detail::ScanPose> poses;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    detail::ScanPose& scan = poses.emplace_back();
    scan.path = subjects[i].path;
    scan.name = subjects[i].name;
    scan.time = subjects[i].time;
    scan.pose = own_[i].value_or(Pose());
  }
  assigned_ = assignPoses(poses, options);
  for (std::size_t i = 0; i < subjects.size(); ++i)
    if (own_[i] || (!options.poses.empty() && !assigned_.left_out[i])) own_[i] = poses[i].pose;
}

std::vector<double> RegisterGuesses::times() const {
  std::vector<double> times;
  for (const std::optional<double>& time : assigned_.times)
    if (time) times.push_back(*time);
  if (std::set<double>(times.begin(), times.end()).size() == subjects_.size()) return times;
  std::vector<std::filesystem::path> paths;
  for (const Subject& subject : subjects_) paths.push_back(subject.path);
  const std::vector<std::uint64_t> indices = detail::numbersIn(detail::scanNames(paths)).indices;
  times.clear();
  for (std::size_t i = 0; i < paths.size(); ++i) times.push_back(indices.empty() ? double(i) : double(indices[i]));
  return times;
}

std::vector<Pose> RegisterGuesses::of(std::size_t i) const {
  std::vector<Pose> guesses;
  if (own_first_ && own_[i]) guesses.push_back(*own_[i]);
  if (last_) {
    const bool has_motion = own_[i] && own_[*last_];
    guesses.push_back(has_motion ? last_pose_ * own_[*last_]->inverse() * *own_[i] : last_pose_);
  } else if (guess_) {
    const bool has_motion = i > 0 && own_[i] && own_[0];  // the scans before were not found
    guesses.push_back(has_motion ? *guess_ * own_[0]->inverse() * *own_[i] : *guess_);
  }
  if (guesses.empty()) guesses.push_back(own_[0].value_or(Pose()));
  return guesses;
}

void RegisterGuesses::found(std::size_t i, const Pose& pose) {
  last_ = i;
  last_pose_ = pose;
}

}  // namespace gaussmap::app
