// SPDX-License-Identifier: BSD-3-Clause
// Finds scans and their poses, and checks both.
#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "gaussmap/io/scans/file_scans.h"
#include "io/scans/assign_poses.h"
#include "io/scans/keeping_points.h"
#include "io/scans/pose_checks.h"
#include "io/scans/scan_files.h"
#include "sensor/sensor_motion.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Warns if a scan is given more than once, for example as a file and by its directory.
void warnOfScansGivenTwice(const std::vector<std::filesystem::path>& paths, std::vector<std::string>& warnings) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& path : paths) {
    std::error_code error;
    if (seen.insert(std::filesystem::weakly_canonical(path, error)).second || error) continue;
    warnings.push_back(path.string() + " is given more than once, so its points count more than once");
    return;
  }
}

/// The scans of some files, as they are before poses are assigned.
struct ListedScans {
  std::shared_ptr<ScanFiles> files;
  std::vector<FileScan> scans;
  std::vector<ScanPose> poses;
  std::vector<std::string> warnings;
};

/// Adds all scans of a file.
void addScansOf(const std::filesystem::path& path, ListedScans& listed) {
  const std::shared_ptr<const ScanFile> file = listed.files->add(path).file;
  const auto file_poses = std::make_shared<const PosesInFile>(PosesInFile{file->poseSource(), file->missingPoses()});
  for (std::size_t i = 0; i < file->size(); ++i) {
    const FileScanInfo info = file->info(i);
    listed.scans.push_back({path, Pose(), std::nullopt, i, info.name, true});
    ScanPose& scan = listed.poses.emplace_back();
    scan.path = path;
    scan.name = info.name;
    scan.time = info.time;
    scan.pose = info.pose.value_or(Pose());
    scan.position_step = info.position_step;
    scan.has_pose = info.pose.has_value();
    scan.in_map_frame = file->inMapFrame();
    scan.file_poses = file_poses;
    scan.fingerprint =
        info.fingerprint != 0 ? info.fingerprint : std::hash<std::string>()(path.string() + ":" + std::to_string(i));
  }
  for (const std::string& warning : file->warnings()) listed.warnings.push_back(path.string() + ": " + warning);
  file->releasePages();
}

/// Returns true if the points of scans with the same pose show that the sensor stood still.
bool standsStill(FileScans& scans) {
  const KeepingPoints keeping(scans);
  try {
    const std::optional<SameView> views = compareViews(scans);
    return views && !views->moved();
  } catch (const FileError&) {
    return false;  // a later read reports it
  }
}

}  // namespace

FoundScans findScans(const std::vector<std::filesystem::path>& inputs, const FindScansOptions& options) {
  const std::vector<std::filesystem::path> paths = listScans(inputs);
  std::vector<std::string> warnings;
  warnOfScansGivenTwice(paths, warnings);
  const OpenOptions opening{options.files, options.poses.empty(), options.matching.max_time_gap};
  ListedScans listed{std::make_shared<ScanFiles>(opening), {}, {}, {}};
  for (const std::filesystem::path& path : paths) addScansOf(path, listed);
  warnings.insert(warnings.end(), listed.warnings.begin(), listed.warnings.end());
  std::vector<ScanPose>& checked = listed.poses;
  AssignedPoses assigned = assignPoses(checked, options);
  warnings.insert(warnings.end(), assigned.warnings.begin(), assigned.warnings.end());
  std::vector<ScanPose> kept;
  std::vector<FileScan> scans;
  std::vector<Pose> as_read;
  for (std::size_t i = 0; i < checked.size(); ++i) {
    if (assigned.left_out[i]) continue;
    as_read.push_back(poseFault(assigned.as_read[i]).empty() ? normalised(assigned.as_read[i]) : Pose());
    kept.push_back(checked[i]);
    scans.push_back(std::move(listed.scans[i]));
    scans.back().time = assigned.times[i];
    scans.back().has_sensor_position = !checked[i].in_map_frame;
  }
  if (scans.empty()) throw FileError(paths.at(0), "holds no scan");
  if (options.frame == ScanFrame::Map) dropUnneededRotations(kept, warnings);
  const PoseDiagnosis diagnosis = diagnosePoses(kept);
  for (std::size_t i = 0; i < kept.size(); ++i) scans[i].pose = normalised(kept[i].pose);
  FoundScans found{FileScans(std::move(scans), options.frame, std::move(listed.files)),
                   std::move(warnings),
                   std::move(assigned.description),
                   std::move(assigned.without_pose),
                   std::move(as_read),
                   assigned.extrinsic};
  if (options.frame == ScanFrame::Map) return found;
  found.warnings.insert(found.warnings.end(), diagnosis.warnings.begin(), diagnosis.warnings.end());
  if (!diagnosis.same_pose.empty() && !standsStill(found.scans)) found.warnings.push_back(diagnosis.same_pose);
  return found;
}

FoundScans findScans(const std::vector<std::filesystem::path>& inputs, const std::filesystem::path& poses) {
  FindScansOptions options;
  options.poses = poses;
  return findScans(inputs, options);
}

}  // namespace gaussmap
