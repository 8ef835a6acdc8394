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
#include "io/scans/list_scans.h"
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
  std::string map_frame;               // of the first recording with poses
  std::filesystem::path map_frame_of;  // this recording
  bool warned_of_frames = false;
};

/// Throws FileError if the poses of two recordings are in different frames. Warns if they are in frames of the same
/// name that begin where the robot starts.
void checkMapFrame(const std::filesystem::path& path, const std::string& frame, ListedScans& listed) {
  if (listed.map_frame.empty()) {
    listed.map_frame = frame;
    listed.map_frame_of = path;
    return;
  }
  const std::string first = listed.map_frame_of.string();
  if (listed.map_frame != frame)
    throw FileError(path, "the poses are in the frame " + frame + ", but those of " + first + " are in " +
                              listed.map_frame + "; name a frame that all recordings have with --fixed-frame");
  const std::string last = frame.substr(frame.find_last_of('/') + 1);
  if ((last != "odom" && last != "camera_init") || listed.warned_of_frames) return;
  listed.warned_of_frames = true;
  listed.warnings.push_back(path.string() + " and " + first + " have poses in " + frame +
                            ", which begins at another place in each run; the map is wrong if they are different runs");
}

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
    scan.sensor_in_pose_frame = info.sensor_in_pose_frame;
    scan.file_poses = file_poses;
    scan.fingerprint =
        info.fingerprint != 0 ? info.fingerprint : std::hash<std::string>()(path.string() + ":" + std::to_string(i));
  }
  if (const std::string frame = file->mapFrame(); !frame.empty()) checkMapFrame(path, frame, listed);
  for (const std::string& warning : file->warnings()) listed.warnings.push_back(path.string() + ": " + warning);
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
  std::vector<std::string> warnings;
  const std::vector<std::filesystem::path> paths = detail::listScans(inputs, warnings);
  warnOfScansGivenTwice(paths, warnings);
  ListedScans listed{std::make_shared<ScanFiles>(openOptions(options)), {}, {}, {}, {}, {}, false};
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
