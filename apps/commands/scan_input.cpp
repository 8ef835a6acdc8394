// SPDX-License-Identifier: BSD-3-Clause
#include "commands/scan_input.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "commands/recordings.h"
#include "commands/sensor_positions.h"
#include "common/box.h"
#include "common/command.h"
#include "common/report.h"
#include "io/scans/scan_names.h"

namespace gaussmap::app {

std::vector<std::string> scanEndings() {
  return {".pcd", ".pcd.gz", ".ply", ".las", ".laz",  ".e57", ".bin", ".xyz", ".pts",
          ".ptx", ".csv",    ".txt", ".asc", ".mcap", ".db3", ".bag", ".log", ".log.gz"};
}

void addScanPaths(Command& command, ScanInput& input) {
  command.texts("scans", input.paths, "scans (PCD, PLY, LAS, LAZ, E57, text, CARMEN, MCAP, bag ...), or directories")
      .required();
  command.files({"scans"}, scanEndings());
}

void addPoseOptions(Command& command, ScanInput& input) {
  command.text(
      "--poses", input.poses,
      "file with the sensor poses in the map frame (TUM, KITTI, CSV ...); for recordings also tf, or a topic such as "
      "/odom; default: the poses in the files");
  command
      .text("--pose-format", input.pose_format,
            R"(auto, tum, tum-wxyz, kitti, matrix4, euroc, xyzrpy-deg, xyzrpy-rad, g2o, csv (a header line names the
            columns), or the columns in quotes: "time x y z qw qx qy qz")")
      .rare();
  command
      .choice(
          "--match-poses", input.match_poses, {"auto", "name", "index", "time", "order"},
          "how poses are matched to scans: by name, by number in the name (index), by time, or in order; auto decides "
          "from the names and the poses")
      .rare();
  command
      .number("--max-time-gap", input.max_time_gap, 0.0, 1e9,
              "largest time between a scan and its pose [s]; default: half of the median time between scans (for one "
              "scan: between poses)")
      .rare();
  command.flag("--interpolate", input.interpolate, "interpolate between the pose before and the pose after the scan")
      .rare();
  command.flag("--skip-without-pose", input.skip_without_pose, "leave out scans without a pose").rare();
  command
      .text("--extrinsic", input.extrinsic,
            R"(pose of the sensor in the frame that the poses describe: file, or "x y z qx qy qz qw"; default: calib.txt
            beside a KITTI pose file, if there is one; none: no extrinsic)")
      .rare();
  addFileOptions(command, input.files);
  command.files({"--poses", "--extrinsic"});
}

void addScanOptions(Command& command, ScanInput& input) {
  addPoseOptions(command, input);
  command.choice("--frame", input.frame, {"sensor", "map"}, "frame of the points in the files");
  addRangeOptions(command, input);
  command
      .numbers("--crop", input.crop, 4, 6, -1e12, 1e12,
               "use only points in this box of the map frame: x0 y0 x1 y1, or x0 y0 z0 x1 y1 z1 [m]")
      .rare();
  addPoseMeaning(command, input.meaning);
}

void addRangeOptions(Command& command, ScanInput& input) {
  command.number("--max-range", input.max_range, 0.0, 1e9,
                 "drop points farther from the sensor than this [m]; 0 = no limit");
  command.number("--min-range", input.min_range, 0.0, 1e9,
                 "drop points nearer to the sensor than this [m], for example the robot itself");
}

namespace {

const std::map<std::string, PoseFormat> kPoseFormats = {{"auto", PoseFormat::Automatic},
                                                        {"tum", PoseFormat::Tum},
                                                        {"tum-wxyz", PoseFormat::Table},
                                                        {"kitti", PoseFormat::Kitti},
                                                        {"matrix4", PoseFormat::Matrix4},
                                                        {"euroc", PoseFormat::EuRoc},
                                                        {"xyzrpy-deg", PoseFormat::XyzRpyDegrees},
                                                        {"xyzrpy-rad", PoseFormat::XyzRpyRadians},
                                                        {"g2o", PoseFormat::G2o},
                                                        {"csv", PoseFormat::Table}};
const std::map<std::string, PoseMatch> kPoseMatches = {{"auto", PoseMatch::Automatic},
                                                       {"name", PoseMatch::Name},
                                                       {"index", PoseMatch::Index},
                                                       {"time", PoseMatch::Time},
                                                       {"order", PoseMatch::Order}};

void setPoseFormat(const std::string& text, FindScansOptions& options) {
  const auto known = kPoseFormats.find(text);
  if (known != kPoseFormats.end()) {
    options.pose_format = known->second;
    if (text == "tum-wxyz") options.pose_columns = "key x y z qw qx qy qz";
    return;
  }
  if (text.find_first_of(" ,;\t") == std::string::npos)
    throw UsageError("--pose-format " + text +
                     ": expected auto, tum, tum-wxyz, kitti, matrix4, euroc, xyzrpy-deg, xyzrpy-rad, g2o, csv, or the "
                     "names of the columns in quotes");
  options.pose_format = PoseFormat::Table;
  options.pose_columns = text;
}

Extrinsic extrinsicIn(const std::string& text) {
  if (text == "none") return {};
  std::istringstream words(text);
  std::vector<double> n;
  for (std::string word; words >> word;) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return readExtrinsic(text);
    n.push_back(value);
  }
  if (n.size() < 2) return readExtrinsic(text);
  if (n.size() != 7)
    throw UsageError("--extrinsic '" + text + "': " + std::to_string(n.size()) +
                     " numbers found, expected the seven of x y z qx qy qz qw, in quotes, or a file");
  const Pose pose{{n[0], n[1], n[2]}, Pose::Rotation(n[6], n[3], n[4], n[5])};
  if (const std::string fault = poseFault(pose); !fault.empty())
    throw UsageError("--extrinsic '" + text + "': " + fault);
  Extrinsic extrinsic;
  extrinsic.pose = normalised(pose);
  return extrinsic;
}

/// Returns true if options are given that only recordings have, or that mean something else for recordings.
bool hasRecordingOptions(const ScanInput& input) {
  const RecordingOptions& recording = input.files.recording;
  return namesTopic(input.poses) || lacksSlash(input.poses) ||
         (input.poses.empty() && (input.max_time_gap || input.skip_without_pose)) || !recording.topic.empty() ||
         !recording.pose_frame.empty() || !recording.fixed_frame.empty() || recording.log_times;
}

/// Throws UsageError for options that have no effect.
void checkOptions(const ScanInput& input, bool has_recording) {
  const auto require = [](bool is_met, bool is_given, const char* option, const char* need) {
    if (is_given && !is_met) throw UsageError(std::string(option) + ": needs " + need);
  };
  require(has_recording, input.poses == "tf", "--poses tf", "a recording of ROS among the inputs");
  const bool has_file = !input.poses.empty() && !(has_recording && namesTopic(input.poses));
  require(has_file, input.pose_format != "auto", "--pose-format", "a file of poses (--poses)");
  require(has_file, input.match_poses != "auto", "--match-poses", "a file of poses (--poses)");
  require(has_file, input.interpolate, "--interpolate",
          "a file of poses (--poses); recordings are always interpolated");
  require(has_file || has_recording, input.max_time_gap.has_value(), "--max-time-gap", "--poses");
  require(has_file || has_recording, input.skip_without_pose, "--skip-without-pose", "--poses");
  const RecordingOptions& recording = input.files.recording;
  const char* const kRecording = "a recording of ROS among the inputs";
  require(has_recording, !recording.topic.empty(), "--topic", kRecording);
  require(has_recording, recording.log_times, "--log-times", kRecording);
  require(has_recording && !has_file, !recording.fixed_frame.empty(), "--fixed-frame",
          "poses of a recording; the poses of a file are in the map frame already");
  require(has_recording, !recording.pose_frame.empty(), "--pose-frame", kRecording);
}

}  // namespace

FindScansOptions findOptions(const ScanInput& input) {
  const bool has_recording = hasRecordingOptions(input) && !recordingsIn(input.paths).empty();
  if (has_recording && lacksSlash(input.poses))
    throw UsageError("--poses " + input.poses + ": no such file; a topic begins with a slash: --poses /" + input.poses);
  checkOptions(input, has_recording);
  FindScansOptions options;
  options.files = input.files;
  if (has_recording && namesTopic(input.poses))
    options.files.recording.poses = input.poses;
  else
    options.poses = input.poses;
  setPoseFormat(input.pose_format, options);
  options.matching = {kPoseMatches.at(input.match_poses), input.max_time_gap, input.interpolate};
  options.convention = input.meaning.convention;
  options.skip_without_pose = input.skip_without_pose;
  if (!input.extrinsic.empty()) options.extrinsic = extrinsicIn(input.extrinsic);
  options.frame = input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor;
  return options;
}

namespace {

/// Throws FileError if ranges are limited, but a file does not say where the sensor was.
void requireRanges(const ScanInput& input, const FileScans& scans) {
  if (input.max_range <= 0.0 && input.min_range <= 0.0) return;
  for (const FileScan& scan : scans.files())
    if (!scan.has_sensor_position)
      throw FileError(scan.path,
                      "the points are in the map frame, and the file does not say where the sensor was, so "
                      "--max-range and --min-range have no meaning; use --crop");
}

}  // namespace

FoundScans findScans(const ScanInput& input, const FindScansOptions& options) {
  try {
    return gaussmap::findScans({input.paths.begin(), input.paths.end()}, options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--") + error.what());
  }
}

std::optional<PoseConvention> impossibleConvention(const ScanInput& input) {
  // VIEWPOINT is read as w x y z.
  return input.poses.empty() ? std::optional(PoseConvention::WFirst) : std::nullopt;
}

FileScans openScans(const ScanInput& input, int threads, const char* follows_rays) {
  const FindScansOptions options = findOptions(input);
  FoundScans found = findScans(input, options);
  if (follows_rays) requireSensorPositions(found.scans, follows_rays);
  requireRanges(input, found.scans);
  if (!options.poses.empty())
    note(found.poses);
  else if (!found.scans.pcd(0))
    note("poses: " + found.poses);
  for (const std::string& warning : found.warnings) warn(warning);
  const PoseFinding finding = checkMeaning(found, input.meaning, impossibleConvention(input), threads);
  if (!finding.fault.empty()) throw std::runtime_error(finding.fault);
  if (!finding.warning.empty()) warn(finding.warning);
  if (const std::string warning = warningOfSystems(found.scans); !warning.empty()) warn(warning);
  return std::move(found.scans);
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  AccumulateOptions options;
  options.resolution = resolution;
  options.threads = threads;
  if (input.max_range > 0.0) options.max_range = input.max_range;
  options.min_range = input.min_range;
  if (options.min_range > options.max_range) throw UsageError("--min-range: must not be above --max-range");
  if (!input.crop.empty()) options.crop = boxOf("--crop", input.crop);
  return options;
}

std::vector<FileSystem> coordinateSystemsOf(const FileScans& scans) {
  std::vector<FileSystem> systems;
  std::string last_path;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::string path = scans.files()[i].path.string();
    if (path == last_path) continue;
    last_path = path;
    std::string system = scans.coordinateSystem(i);
    const bool is_known =
        std::any_of(systems.begin(), systems.end(), [&](const FileSystem& other) { return other.system == system; });
    if (!system.empty() && !is_known) systems.push_back({path, std::move(system)});
  }
  return systems;
}

std::string warningOfSystems(const FileScans& scans) {
  const std::vector<FileSystem> systems = coordinateSystemsOf(scans);
  if (systems.size() < 2) return "";
  return systems[1].path + ": the coordinate reference system differs from that of " + systems[0].path +
         "; the coordinates are used as they are, so convert the files to one system if it is not the same";
}

void warnOfCoordinates(const FileScans& scans, double resolution) {
  for (const std::string& warning : scans.coordinateWarnings(resolution)) warn(warning);
}

std::vector<Vector<3>> readPoints(const ScanInput& input, int threads, double resolution) {
  const FileScans scans = openScans(input, threads);
  std::vector<Vector<3>> points = gaussmap::readPoints(scans, accumulateOptions(input, 1.0, threads));
  warnOfCoordinates(scans, resolution);
  if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
  return points;
}

std::string shortNameOf(const ScanInfo& scan) {
  const std::size_t end = std::min(scan.name.find(": "), scan.name.size());
  return std::filesystem::path(scan.name.substr(0, end)).filename().string() + scan.name.substr(end);
}

std::vector<std::string> shortNamesOf(const Scans& scans) {
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const ScanInfo scan = scans.info(i);
    paths.emplace_back(scan.name);
    names.push_back(shortNameOf(scan));
  }
  const bool is_files = std::none_of(names.begin(), names.end(),
                                     [](const std::string& name) { return name.find(": ") != std::string::npos; });
  return is_files ? detail::scanNames(paths) : names;
}

std::string nameOf(const Scans& scans) {
  if (scans.size() == 0) return "";
  const std::string more = scans.size() > 1 ? " and " + std::to_string(scans.size() - 1) + " more" : "";
  return scans.info(0).name + more;
}

}  // namespace gaussmap::app
