// SPDX-License-Identifier: BSD-3-Clause
// gaussmap register: finds the poses of scans, or of other maps, in the frame of a map.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "commands/planar_input.h"
#include "commands/register/guesses.h"
#include "commands/scan_input.h"
#include "common/command.h"
#include "common/json.h"
#include "common/report.h"
#include "core/accept_points.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/registration/registration.h"
#include "simulation/trajectory.h"

namespace gaussmap::app {
namespace {

const Help kRegisterHelp = {
    "Find the poses of scans or other maps in the frame of a map",
    "gaussmap register scans/ street.gmap --tum poses.tum",
    R"(Prints one line per scan: its pose (x y z qx qy qz qw), the standard deviations of the pose, and the fitness.
The fitness is the share of the scan that lies on the map, from 0 to 1. "degenerate" means that some direction is
unobservable, for example along a corridor.

The search for a scan starts at its own pose, from --poses or its file (VIEWPOINT, tf of a recording ...). If no
part of the scan lies on the map from there, it starts again from the pose found for the scan before, moved by the
motion between the own poses of the two scans. With --guess, the first scan starts at the guess, and each other scan
starts from the scan before in this way. Poses in files that are the same for all scans, or the identity for several
scans, are ignored. A scan without a pose of its own starts at the pose found for the scan before.

A scan without usable points, a damaged file, or a scan that is not found on the map, gets a line on stderr, and the
others are registered. The exit code is then 1.

In a planar map, only x, y and the heading are searched. The height and the tilt of the pose are those of the guess.
3-D scans need --slice: the points between two heights of the map frame, computed with the guess.

Maps can be given in place of scans. A map in place of a scan starts at the identity (it is not moved), unless --guess
or --poses is given.)"};

struct RegisterCommand {
  std::vector<std::string> inputs;  // scans or maps; the last one is the map to register with
  std::vector<double> guess;        // x y z qx qy qz qw of the first scan; empty: its own pose
  ScanInput input;                  // only the poses and the ranges
  std::string tum;
  bool force = false;
  RegistrationOptions options;
  Slice slice;  // of 3-D scans, for a planar map
  bool json = false;
};

Json jsonOf(const Subject& subject, const RegistrationResult& result) {
  const auto& t = result.pose.translation;
  const auto& q = result.pose.rotation;
  Json covariance = Json::array();
  for (Eigen::Index row = 0; row < 6; ++row)
    for (Eigen::Index column = 0; column < 6; ++column) covariance.push_back(result.covariance(row, column));
  return {{"scan", subject.label()},
          {"translation", {t.x(), t.y(), t.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"covariance", covariance},
          {"fitness", result.fitness},
          {"mean_squared_mahalanobis", result.mean_squared},
          {"converged", result.converged},
          {"degenerate", result.degenerate},
          {"iterations", result.iterations}};
}

void print(const Subject& subject, const RegistrationResult& result) {
  const auto& t = result.pose.translation;
  const auto& q = result.pose.rotation;
  const auto deviation = [&](int axis) { return std::sqrt(result.covariance(axis, axis)); };
  const double degrees = 180.0 / std::acos(-1.0);
  std::printf("%s: %.4f %.4f %.4f  %.6f %.6f %.6f %.6f  +- %.4f %.4f %.4f m, %.3f %.3f %.3f deg, fitness %.3f%s%s\n",
              subject.shortLabel().c_str(), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), deviation(0), deviation(1),
              deviation(2), degrees * deviation(3), degrees * deviation(4), degrees * deviation(5), result.fitness,
              result.converged ? "" : ", not converged", result.degenerate ? ", degenerate" : "");
}

/// The scans and maps to register, and what their registration needs.
template <int D>
struct Registration {
  const RegisterCommand& command;
  const GaussianMap<D>& map;
  std::vector<Subject> subjects;
  FileScans scans;                   // those of the subjects that are scans and can be opened
  std::vector<std::size_t> scan_of;  // per subject: index in `scans`
};

/// Returns the scans of the subjects. Their poses are not set.
FileScans scansOf(const std::vector<Subject>& subjects, const FileOptions& options, std::vector<std::size_t>& scan_of) {
  std::vector<FileScan> scans;
  for (const Subject& subject : subjects) {
    scan_of.push_back(scans.size());
    if (!subject.is_map && subject.error.empty())
      scans.push_back({subject.path, Pose(), std::nullopt, subject.index, subject.name});
  }
  return FileScans(std::move(scans), ScanFrame::Sensor, options);
}

/// Returns a scan with the given pose without the points that a planar map does not show. Throws FileError if it is a
/// 3-D scan, and there is no slice.
Scan planarPart(Scan scan, const Pose& guess, const Subject& subject, const Slice& slice) {
  scan.pose = guess;
  try {
    const Scan level = detail::levelled(scan, planarOptions(slice, {}));
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      if (!isReturn(level.points[i])) scan.points[i] = level.points[i];
  } catch (const std::invalid_argument& error) {
    throw FileError(subject.path, (subject.name.empty() ? "" : subject.name + ": ") + error.what());
  }
  return scan;
}

/// Registers a scan or a map. Throws FileError if the file is damaged or has no usable point.
template <int D>
RegistrationResult registerOne(const Registration<D>& all, std::size_t i, const Pose& guess) {
  const Subject& subject = all.subjects[i];
  const RegisterCommand& command = all.command;
  if (subject.is_map) {
    const GaussianMap<D> source = loadMap<D>(subject.path);
    if (source.empty()) throw FileError(subject.path, "the map is empty");
    return registerMap(source, all.map, guess, command.options);
  }
  Scan scan = all.scans.read(all.scan_of[i]);
  detail::dropPoints(detail::limitsOf(accumulateOptions(command.input, all.map.grid().side(0), 0)), scan);
  if (D == 2) scan = planarPart(std::move(scan), guess, subject, command.slice);
  if (std::none_of(scan.points.begin(), scan.points.end(), isReturn))
    throw FileError(subject.path, (subject.name.empty() ? "" : subject.name + ": ") + "no usable point" +
                                      (command.slice.empty() ? "" : " between the heights of --slice"));
  return registerScan(scan.points, all.map, guess, command.options);
}

/// Tries the guesses until a part of the scan lies on the map. Throws FileError if none does.
template <int D>
RegistrationResult findScan(const Registration<D>& all, std::size_t i, const std::vector<Pose>& guesses) {
  const Subject& subject = all.subjects[i];
  for (const Pose& guess : guesses) {
    RegistrationResult result = registerOne(all, i, guess);
    if (result.fitness > 0.0) return result;
  }
  throw FileError(subject.path, (subject.name.empty() ? "" : subject.name + ": ") +
                                    "no part of the scan lies on the map after the search; use a better --guess or "
                                    "--poses");
}

/// Below this fitness the program says that the pose may be wrong. Measured: right poses of scans of a mapped place
/// have 0.39 to 0.95.
constexpr double kLowFitness = 0.35;

void warnIfDoubtful(const Subject& subject, const RegistrationResult& result) {
  if (result.fitness >= kLowFitness) return;
  warn(subject.label() + ": only " + formatted("%.0f", 100.0 * result.fitness) +
       " % of the scan lies on the map, so the pose may be wrong; check it, or use a better --guess or --poses");
}

template <int D>
void run(const RegisterCommand& command) {
  checkSlice(command.slice);
  if (D == 3 && !command.slice.empty()) throw UsageError("--slice: only for planar maps");
  const std::filesystem::path map_path = command.inputs.back();
  const std::vector<std::filesystem::path> files = listScans({command.inputs.begin(), std::prev(command.inputs.end())});
  if (!command.tum.empty()) {
    std::vector<std::filesystem::path> inputs = files;
    inputs.push_back(map_path);
    if (!command.input.poses.empty()) inputs.emplace_back(command.input.poses);
    checkOutput({command.tum, command.force}, inputs);
    refuseOtherKinds(command.tum, "a file of poses", {".tum", ".txt", ".csv"});
  }
  ScanInput input = command.input;
  input.paths = {command.inputs.begin(), std::prev(command.inputs.end())};
  const FindScansOptions options = findOptions(input);
  std::vector<Subject> subjects = subjectsIn(files, options);
  RegisterGuesses guesses(subjects, options, command.guess);
  if (!options.poses.empty()) note(guesses.description());
  for (const std::string& warning : guesses.warnings()) warn(warning);
  const GaussianMap<D> map = loadMap<D>(map_path);
  if (map.empty()) throw FileError(map_path, "the map is empty, so no scan can be registered with it");
  std::vector<std::size_t> scan_of;
  FileScans scans = scansOf(subjects, options.files, scan_of);
  const Registration<D> all{command, map, std::move(subjects), std::move(scans), std::move(scan_of)};

  const std::vector<double> times = guesses.times();
  Json found = Json::array();
  std::vector<TimedPose> trajectory;
  std::size_t not_found = 0;
  for (std::size_t i = 0; i < all.subjects.size(); ++i) {
    if (guesses.isLeftOut(i)) continue;
    const Subject& subject = all.subjects[i];
    try {
      if (!subject.error.empty()) throw std::runtime_error(subject.error);
      const RegistrationResult result = findScan(all, i, guesses.of(i));
      guesses.found(i, result.pose);
      trajectory.push_back({times[i], result.pose});
      if (command.json)
        found.push_back(jsonOf(subject, result));
      else
        print(subject, result);
      warnIfDoubtful(subject, result);
    } catch (const std::runtime_error& error) {
      if (all.subjects.size() == 1) throw;
      std::fflush(stdout);
      std::cerr << "gaussmap: " << error.what() << std::endl;
      if (command.json) found.push_back({{"scan", subject.label()}, {"error", error.what()}});
      ++not_found;
    }
  }
  warnOfCoordinates(all.scans, map.grid().side(0));
  if (!command.tum.empty() && !trajectory.empty()) writeTum(command.tum, trajectory);
  if (command.json) printJson(found);
  if (not_found > 0)
    throw std::runtime_error(std::to_string(not_found) + " of " + std::to_string(all.subjects.size()) +
                             (not_found == 1 ? " scans was" : " scans were") + " not registered, see above");
}

}  // namespace

void addRegister(CLI::App& app) {
  auto options = std::make_shared<RegisterCommand>();
  Command command(app, "register", kRegisterHelp);
  command
      .texts("inputs", options->inputs,
             "scans (files of any kind that pcd2map reads, or directories) or maps to register; last: the map that "
             "defines the frame")
      .required()
      .atLeast(2);
  command.numbers("--guess", options->guess, 7, -1e12, 1e12,
                  "pose at which the search for the first scan starts: x y z [m] qx qy qz qw");
  addPoseOptions(command, options->input);
  command.text("--tum", options->tum,
               "TUM file to write, one line per scan: time, x y z [m] qx qy qz qw; the time is that of the scan "
               "(in its name or its file), or else the number in its name, or else 0, 1, 2 ...");
  command.force(options->force, "replace an existing file of poses");
  command
      .number("--scan-resolution", options->options.resolution, 0.0, 1e6,
              "side of the cells whose Gaussians represent the scan [m], 0 = side of the finest cells of the map")
      .rare();
  command
      .number("--kernel", options->options.kernel, 1e-3, 1e6,
              "robust kernel: halves the cost of a residual of this many standard deviations")
      .rare();
  addRangeOptions(command, options->input);
  addSlice(command, options->slice);
  command.threads(options->options.threads);
  command.json(options->json);
  std::vector<std::string> endings = scanEndings();
  endings.emplace_back(".gmap");
  command.files({"inputs"}, endings);
  command.files({"--tum"});
  command.onRun([options] { forMap(options->inputs.back(), [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
