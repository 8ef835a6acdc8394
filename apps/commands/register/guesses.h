// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"

namespace gaussmap::app {

/// Returns the time of each scan for a TUM file: the last number in its file name. If a name has no number, or two
/// scans have the same one, returns 0, 1, 2 and so on.
std::vector<double> timesOf(const std::vector<std::filesystem::path>& scans);

/// The poses at which the search for each scan starts.
///
/// Each scan has an own pose, from a pose file or its VIEWPOINT. VIEWPOINTs that have a fault, or that several scans
/// share, are not poses of the scans.
class RegisterGuesses {
 public:
  /// `poses` = pose file, empty: the VIEWPOINTs. `guess` = x y z qx qy qz qw of the first scan, or empty. Throws
  /// UsageError if `guess` has a fault; FileError if the pose file does not fit the scans, or if the VIEWPOINT of a
  /// single scan has a fault and there is no other guess.
  RegisterGuesses(const std::vector<std::filesystem::path>& scans, const std::string& poses,
                  const std::vector<double>& guess);

  /// Returns the guesses for scan `i`, the best one first. There is at least one.
  std::vector<Pose> of(std::size_t i) const;
  /// Notes the result for scan `i`, on which the guesses for later scans depend.
  void found(std::size_t i, const Pose& pose);

 private:
  std::vector<std::optional<Pose>> own_;  // per scan
  std::optional<Pose> guess_;             // of the first scan
  bool own_first_ = true;                 // false: own poses give only the motion
  std::optional<std::size_t> last_;       // the last scan that was found
  Pose last_pose_;
};

}  // namespace gaussmap::app
