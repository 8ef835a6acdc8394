// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/assign_poses.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include "core/same_pose.h"
#include "io/pcd/pcd_scan_file.h"
#include "io/scans/name_numbers.h"
#include "io/scans/pose_times.h"
#include "io/scans/scan_names.h"

namespace gaussmap::detail {
namespace {

std::string formatText(PoseFormat format) {
  switch (format) {
    case PoseFormat::Tum:
      return "TUM";
    case PoseFormat::Kitti:
      return "KITTI";
    case PoseFormat::Matrix4:
      return "matrices";
    case PoseFormat::EuRoc:
      return "EuRoC";
    case PoseFormat::G2o:
      return "g2o";
    default:
      return "table";
  }
}

std::string countText(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

using ScanTimes = std::vector<std::optional<double>>;  // per scan [s]

/// Returns true if no scan has a time near those of the poses, so the times are from different clocks.
bool clocksDiffer(const PoseFile& file, const ScanTimes& times) {
  constexpr double kNear = 10.0;  // [s]
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PoseFile::Entry& entry : file.entries) {
    if (!entry.time) continue;
    low = std::min(low, secondsOf(*entry.time));
    high = std::max(high, secondsOf(*entry.time));
  }
  return std::none_of(times.begin(), times.end(), [&](const std::optional<double>& time) {
    return time && *time >= low - kNear && *time <= high + kNear;
  });
}

/// Returns what to do about scans without a pose.
std::string wayOut(const PoseFile& file, const MatchedPoses& matched, const ScanTimes& times) {
  const bool none = matched.missing.size() == times.size();
  const std::string order = file.entries.size() == times.size()
                                ? ", or use --match-poses order if the lines are in the order of the scans"
                                : "";
  if (none && matched.match == PoseMatch::Time && clocksDiffer(file, times))
    return "check that both use the same clock" + order;
  const std::string start = none ? "give the pose of each scan" : "use --skip-without-pose to leave such scans out";
  if (matched.match == PoseMatch::Time) return start + ", or use --max-time-gap if the nearest poses are right";
  return matched.match == PoseMatch::Index ? start + order : start;
}

/// "2 of 6 scans have no pose: a.pcd (no index 3), b.pcd (no index 4)"
std::string missingText(const MatchedPoses& matched, const std::vector<ScanKey>& scans) {
  const std::size_t count = matched.missing.size(), kNamed = count < scans.size() ? 3 : 1;
  std::string text = std::to_string(count) + " of " + countText(scans.size(), "scan") +
                     (count == 1 ? " has no pose: " : " have no pose: ");
  for (std::size_t i = 0; i < std::min(count, kNamed); ++i)
    text += (i > 0 ? ", " : "") + scans[matched.missing[i].scan].name + " (" + matched.missing[i].reason + ")";
  return text + (count > kNamed ? " ..." : "");
}

bool isPlainKitti(const PoseFile& file) {
  return file.format == PoseFormat::Kitti && !file.by_name &&
         std::none_of(file.entries.begin(), file.entries.end(),
                      [](const PoseFile::Entry& entry) { return entry.time; });
}

/// Returns the calibration beside a KITTI pose file, if there is one.
std::optional<Extrinsic> calibrationBeside(const PoseFile& file, std::vector<std::string>& warnings) {
  if (!isPlainKitti(file)) return std::nullopt;
  const std::filesystem::path calibration = file.path.parent_path() / "calib.txt";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(calibration, ignored)) return std::nullopt;
  try {
    return readExtrinsic(calibration);
  } catch (const FileError& error) {
    warnings.push_back(std::string(error.what()) + ". The poses of " + file.path.string() +
                       " are used as those of the sensor.");
    return std::nullopt;
  }
}

void readPoses(std::vector<ScanPose>& scans, const std::vector<ScanKey>& keys, const FindScansOptions& options,
               AssignedPoses& assigned, std::optional<Extrinsic>& extrinsic) {
  const PoseFile file = readPoseFile(options.poses, options.pose_format, options.pose_columns);
  MatchedPoses matched = matchPoses(file, keys, options.matching);
  assigned.warnings = std::move(matched.warnings);
  assigned.description = file.path.string() + ": " + formatText(file.format) + " (" + file.layout + "), " +
                         countText(file.entries.size(), "pose") + " for " + countText(scans.size(), "scan") + ", " +
                         matched.how;
  if (!matched.missing.empty()) {
    const std::string what = missingText(matched, keys);
    const bool none = matched.missing.size() == scans.size();
    if (none || !options.skip_without_pose)
      throw FileError(file.path,
                      what + (none ? "; " + matched.how : "") + "; " + wayOut(file, matched, assigned.times));
    assigned.warnings.push_back(file.path.string() + ": " + what);
  }
  for (const MatchedPoses::Missing& missing : matched.missing) {
    assigned.left_out[missing.scan] = true;
    assigned.without_pose.push_back(scans[missing.scan].label() + ": " + missing.reason);
  }
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (matched.poses[i]) {
      scans[i].pose = *matched.poses[i];
      if (scans[i].sensor_in_pose_frame && poseFault(scans[i].pose).empty())
        scans[i].pose = normalised(scans[i].pose) * *scans[i].sensor_in_pose_frame;
      scans[i].position_step = 0.0;
      scans[i].in_map_frame = false;
    }
  if (!extrinsic) extrinsic = calibrationBeside(file, assigned.warnings);
}

/// Adds a text if it is not among the others.
void addOnce(const std::string& text, std::vector<std::string>& texts) {
  if (!text.empty() && std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(text);
}

/// Takes the poses that the files have. Throws FileError if a scan needs a pose but has no pose.
void posesOfFiles(const std::vector<ScanPose>& scans, const FindScansOptions& options, AssignedPoses& assigned) {
  std::vector<std::string> sources, missing;
  bool without_source = false;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanPose& scan = scans[i];
    if (scan.in_map_frame && (!scan.file_poses || scan.file_poses->source.empty()))
      addOnce("none needed: the points are in the map frame", sources);
    if (!scan.file_poses) continue;
    addOnce(scan.file_poses->source, sources);
    if (!scan.has_pose && !scan.in_map_frame && scan.file_poses->missing.reason.empty()) without_source = true;
    const MissingPoses& why = scan.file_poses->missing;
    if (scan.has_pose || why.reason.empty() || options.frame == ScanFrame::Map) continue;
    const bool may_be_alone = scans.size() == 1 && options.files.recording.poses.empty();
    if (!may_be_alone && !options.skip_without_pose) throw FileError(scan.path, why.reason + "; " + why.advice);
    addOnce(scan.path.string() + ": " + why.reason, missing);
    if (may_be_alone) continue;
    assigned.left_out[i] = true;
    assigned.without_pose.push_back(scan.label());
  }
  if (!scans.empty() && assigned.without_pose.size() == scans.size())
    throw FileError(scans.front().path,
                    scans.front().file_poses->missing.reason + "; " + scans.front().file_poses->missing.advice);
  assigned.warnings.insert(assigned.warnings.end(), missing.begin(), missing.end());
  for (const std::string& source : sources) assigned.description += (assigned.description.empty() ? "" : "; ") + source;
  if (sources.empty())
    assigned.description = "none in the files, so the sensor is at the origin";
  else if (without_source)
    assigned.description += "; none in the other files";
}

/// Throws FileError if the options change poses that a scan does not have, or whose meaning is known.
void requirePosesToChange(const std::vector<ScanPose>& scans, const FindScansOptions& options) {
  const bool turns = options.convention != PoseConvention::SensorToMap;
  const bool swaps = options.convention == PoseConvention::WFirst || options.convention == PoseConvention::WLast;
  const bool moves = options.extrinsic && !samePose(options.extrinsic->pose, Pose());
  for (const ScanPose& scan : scans) {
    if (turns && !scan.has_pose) throw FileError(scan.path, "has no pose, so --pose-convention has nothing to convert");
    if (swaps && scan.file_poses && scan.file_poses->source != kViewpointSource)
      throw FileError(scan.path,
                      "the order of its quaternions is known, so --pose-convention w-first and w-last have "
                      "no meaning");
    if (moves && scan.in_map_frame)
      throw FileError(scan.path, "the points are in the map frame, so --extrinsic has nothing to move");
  }
}

/// The names and times of the scans.
std::vector<ScanKey> keysOf(const std::vector<ScanPose>& scans) {
  std::vector<std::filesystem::path> paths;
  paths.reserve(scans.size());
  for (const ScanPose& scan : scans) paths.push_back(scan.path);
  const std::vector<std::string> names = scanNames(paths);
  std::vector<ScanKey> keys;
  keys.reserve(names.size());
  for (std::size_t i = 0; i < scans.size(); ++i)
    keys.push_back({scans[i].name.empty() ? names[i] : scans[i].name, scans[i].time});
  return keys;
}

/// Sets the times that the files or the names of the scans have.
void setTimes(const std::vector<ScanKey>& keys, AssignedPoses& assigned) {
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const ScanKey& key : keys) names.push_back(key.name);
  const std::vector<Decimal> written = numbersIn(names).times;
  const std::vector<Instant> times = timesIn(written, unitByMagnitude(largestOf(written)));
  for (std::size_t i = 0; i < times.size(); ++i) assigned.times[i] = secondsOf(times[i]);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].time) assigned.times[i] = secondsOf(*keys[i].time);
}

}  // namespace

AssignedPoses assignPoses(std::vector<ScanPose>& scans, const FindScansOptions& options) {
  AssignedPoses assigned;
  assigned.left_out.resize(scans.size());
  assigned.times.resize(scans.size());
  const std::vector<ScanKey> keys = keysOf(scans);
  setTimes(keys, assigned);
  std::optional<Extrinsic> extrinsic = options.extrinsic;
  if (options.poses.empty()) {
    posesOfFiles(scans, options, assigned);
    requirePosesToChange(scans, options);
  } else {
    readPoses(scans, keys, options, assigned, extrinsic);
  }
  for (const ScanPose& scan : scans) assigned.as_read.push_back(scan.pose);
  const bool moves = extrinsic && !samePose(extrinsic->pose, Pose());
  if (!moves && options.convention == PoseConvention::SensorToMap) return assigned;
  if (moves) assigned.extrinsic = extrinsic->pose;
  const Pose& sensor = assigned.extrinsic;
  const Pose back = moves && extrinsic->turns_map ? sensor.inverse() : Pose();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (assigned.left_out[i]) continue;
    if (const std::string fault = poseFault(scans[i].pose); !fault.empty()) throw FileError(scans[i].path, fault);
    scans[i].pose = back * (poseAs(options.convention, normalised(scans[i].pose)) * sensor);
  }
  if (!moves) return assigned;
  assigned.description += "; extrinsic";
  if (!extrinsic->file.empty()) assigned.description += " of " + extrinsic->file.string();
  assigned.description += extrinsic->turns_map
                              ? " applied as Tr^-1 T Tr, so the map has the axes of the lidar (--extrinsic none: not)"
                              : " applied";
  return assigned;
}

}  // namespace gaussmap::detail
