// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "gaussmap/io/scans/pose_file.h"
#include "io/scans/time_text.h"

namespace gaussmap::detail {

/// Returns the times in this unit; empty if one of them is out of range.
GAUSSMAP_API std::vector<Instant> timesIn(const std::vector<Decimal>& written, TimeUnit unit);

/// The poses of a file in the order of their times.
class PoseTimes {
 public:
  /// All entries of the file must have a time. Keeps a reference to the file.
  explicit PoseTimes(const PoseFile& file);

  /// Returns the unit of the times of scans: that of their magnitude, or, for whole numbers that then all lie outside
  /// the times of the poses, the only unit in which most of them lie within.
  TimeUnit unitOf(const std::vector<Decimal>& scans) const;

  /// Fills in the poses, the missing scans and the warnings of `matched`. There is one time per scan.
  void match(const std::vector<Instant>& times, const std::vector<ScanKey>& scans, const PoseMatching& options,
             MatchedPoses& matched) const;

 private:
  struct Step;
  /// The largest accepted times between a scan and its nearest pose.
  struct Limits {
    Instant nearest{};       ///< if the scan gets the nearest pose
    Instant outside{};       ///< before the first pose or behind the last one, without a warning
    Instant interpolated{};  ///< if the scan is between two poses, which are interpolated
    Instant usual{};         ///< the same as interpolated, without a warning
  };
  const PoseFile::Entry& entry(std::size_t i) const { return file_.entries[order_[i]]; }
  Instant time(std::size_t i) const { return *entry(i).time; }
  std::size_t nearest(Instant time) const;
  Limits limits(const std::vector<Instant>& times, const PoseMatching& options) const;
  std::optional<Step> stepAt(Instant time) const;
  void requireOne(std::size_t i) const;
  void warnOfSharedPoses(const std::vector<Instant>& times, const std::vector<ScanKey>& scans,
                         const std::vector<std::optional<std::size_t>>& nearest, MatchedPoses& matched) const;

  const PoseFile& file_;
  std::vector<std::size_t> order_;  // of the entries, by time
};

}  // namespace gaussmap::detail
