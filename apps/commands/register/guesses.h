// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "commands/register/subjects.h"
#include "gaussmap/core/pose.h"
#include "io/scans/assign_poses.h"

namespace gaussmap::app {

/// The poses at which the search for each scan starts.
///
/// A scan can have an own pose, from a pose file or its own file. Poses in files that have a fault, or that several
/// scans share, are not poses of the scans.
class RegisterGuesses {
 public:
  /// `options`: how own poses are found. `guess`: x y z qx qy qz qw of the first scan, or empty. Throws UsageError if
  /// `guess` has a fault; FileError if the pose file does not fit the scans, or if the pose of the first scan has a
  /// fault and there is no other guess.
  RegisterGuesses(const std::vector<Subject>& subjects, const FindScansOptions& options,
                  const std::vector<double>& guess);

  /// Returns the guesses for scan `i`, the best one first. There is at least one.
  std::vector<Pose> of(std::size_t i) const;
  /// Notes the result for scan `i`, on which the guesses for later scans depend.
  void found(std::size_t i, const Pose& pose);
  /// Returns true if the pose file has no pose for scan `i`, and such scans are to be left out.
  bool isLeftOut(std::size_t i) const { return assigned_.left_out[i]; }

  /// Where the poses come from, one sentence.
  const std::string& description() const { return assigned_.description; }
  const std::vector<std::string>& warnings() const { return assigned_.warnings; }
  /// Returns the time of each scan for a TUM file: the time in its name [s], or else the number in its name. If a
  /// name has no number, or two scans have the same one, returns 0, 1, 2 and so on.
  std::vector<double> times() const;

 private:
  std::vector<Subject> subjects_;
  detail::AssignedPoses assigned_;
  std::vector<std::optional<Pose>> own_;  // per scan
  std::optional<Pose> guess_;             // of the first scan
  bool own_first_ = true;                 // false: own poses give only the motion
  std::optional<std::size_t> last_;       // the last scan that was found
  Pose last_pose_;
};

}  // namespace gaussmap::app
