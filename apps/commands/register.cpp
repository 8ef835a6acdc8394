// SPDX-License-Identifier: BSD-3-Clause
// gaussmap register: finds the poses of scans, or of other maps, in the frame of a map.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "commands/commands.h"
#include "commands/register/guesses.h"
#include "commands/scan_input.h"
#include "common/command.h"
#include "common/json.h"
#include "common/report.h"
#include "core/accept_points.h"
#include "gaussmap/io/pcd/map_pcd.h"
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

The search for a scan starts at its own pose, from --poses or the VIEWPOINT in its header. If no part of the scan lies
on the map from there, it starts again from the pose found for the scan before, moved by the motion between the own
poses of the two scans. With --guess, the first scan starts at the guess, and each other scan starts from the scan
before in this way. VIEWPOINTs that are the same for all scans, or the identity for several scans, are no own poses.
A scan without an own pose starts at the pose found for the scan before.

A scan without usable points, a damaged file, or a scan that is not found on the map, gets a line on stderr, and the
others are registered. The exit code is then 1.

Maps can be given in place of scans. A map in place of a scan starts at the identity (it is not moved), unless --guess
or --poses is given.)"};

struct RegisterCommand {
  std::vector<std::string> inputs;  // scans or maps; the last one is the map to register with
  std::vector<double> guess;        // x y z qx qy qz qw of the first scan; empty: its own pose
  ScanInput input;                  // only the poses and the ranges
  std::string tum;
  bool force = false;
  RegistrationOptions options;
  bool json = false;
};

Json jsonOf(const std::filesystem::path& scan, const RegistrationResult& result) {
  const auto& t = result.pose.translation;
  const auto& q = result.pose.rotation;
  Json covariance = Json::array();
  for (Eigen::Index row = 0; row < 6; ++row)
    for (Eigen::Index column = 0; column < 6; ++column) covariance.push_back(result.covariance(row, column));
  return {{"scan", scan.string()},
          {"translation", {t.x(), t.y(), t.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"covariance", covariance},
          {"fitness", result.fitness},
          {"mean_squared_mahalanobis", result.mean_squared},
          {"converged", result.converged},
          {"degenerate", result.degenerate},
          {"iterations", result.iterations}};
}

void print(const std::filesystem::path& scan, const RegistrationResult& result) {
  const auto& t = result.pose.translation;
  const auto& q = result.pose.rotation;
  const auto deviation = [&](int axis) { return std::sqrt(result.covariance(axis, axis)); };
  const double degrees = 180.0 / std::acos(-1.0);
  std::printf("%s: %.4f %.4f %.4f  %.6f %.6f %.6f %.6f  +- %.4f %.4f %.4f m, %.3f %.3f %.3f deg, fitness %.3f%s%s\n",
              scan.filename().string().c_str(), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w(), deviation(0),
              deviation(1), deviation(2), degrees * deviation(3), degrees * deviation(4), degrees * deviation(5),
              result.fitness, result.converged ? "" : ", not converged", result.degenerate ? ", degenerate" : "");
}

/// Registers a scan or a map. Throws FileError if the file is damaged or has no usable point.
RegistrationResult registerFile(const std::filesystem::path& path, const GaussianMap<3>& map, const Pose& guess,
                                const RegisterCommand& command) {
  if (isMap(path)) {
    const GaussianMap<3> source = loadAny(path);
    if (source.empty()) throw FileError(path, "the map is empty");
    return registerMap(source, map, guess, command.options);
  }
  const FileScans scans({{path, Pose()}});
  Scan scan = scans.read(0);
  warnOfCoordinates(scans, map.grid().side(0));
  detail::dropPoints(detail::limitsOf(accumulateOptions(command.input, map.grid().side(0), 0)), scan);
  if (std::none_of(scan.points.begin(), scan.points.end(), isReturn)) throw FileError(path, "no usable point");
  return registerScan(scan.points, map, guess, command.options);
}

/// Tries the guesses until a part of the scan lies on the map. Throws FileError if none does.
RegistrationResult findScan(const std::filesystem::path& path, const GaussianMap<3>& map,
                            const std::vector<Pose>& guesses, const RegisterCommand& command) {
  for (const Pose& guess : guesses) {
    RegistrationResult result = registerFile(path, map, guess, command);
    if (result.fitness > 0.0) return result;
  }
  throw FileError(path, "no part of the scan lies on the map after the search; use a better --guess or --poses");
}

/// Below this fitness the program says that the pose may be wrong. Measured: right poses of scans of a mapped place
/// have 0.39 to 0.95.
constexpr double kLowFitness = 0.35;

void warnIfDoubtful(const std::filesystem::path& path, const RegistrationResult& result) {
  if (result.fitness >= kLowFitness) return;
  warn(path.string() + ": only " + formatted("%.0f", 100.0 * result.fitness) +
       " % of the scan lies on the map, so the pose may be wrong; check it, or use a better --guess or --poses");
}

void run(const RegisterCommand& command) {
  const std::filesystem::path map_path = command.inputs.back();
  const std::vector<std::filesystem::path> scans = listScans({command.inputs.begin(), std::prev(command.inputs.end())});
  if (!command.tum.empty()) {
    std::vector<std::filesystem::path> inputs = scans;
    inputs.push_back(map_path);
    if (!command.input.poses.empty()) inputs.emplace_back(command.input.poses);
    checkOutput({command.tum, command.force}, inputs);
    refuseOtherKinds(command.tum, "a file of poses", {".tum", ".txt", ".csv"});
  }
  RegisterGuesses guesses(scans, findOptions(command.input), command.guess);
  if (!command.input.poses.empty()) note(guesses.description());
  for (const std::string& warning : guesses.warnings()) warn(warning);
  const GaussianMap<3> map = loadAny(map_path);
  if (map.empty()) throw FileError(map_path, "the map is empty, so no scan can be registered with it");

  const std::vector<double> times = guesses.times();
  Json all = Json::array();
  std::vector<TimedPose> trajectory;
  std::size_t not_found = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (guesses.isLeftOut(i)) continue;
    try {
      const RegistrationResult result = findScan(scans[i], map, guesses.of(i), command);
      guesses.found(i, result.pose);
      trajectory.push_back({times[i], result.pose});
      if (command.json)
        all.push_back(jsonOf(scans[i], result));
      else
        print(scans[i], result);
      warnIfDoubtful(scans[i], result);
    } catch (const FileError& error) {
      if (scans.size() == 1) throw;
      std::fflush(stdout);
      std::cerr << "gaussmap: " << error.what() << std::endl;
      if (command.json) all.push_back({{"scan", scans[i].string()}, {"error", error.what()}});
      ++not_found;
    }
  }
  if (!command.tum.empty() && !trajectory.empty()) writeTum(command.tum, trajectory);
  if (command.json) printJson(all);
  if (not_found > 0)
    throw std::runtime_error(std::to_string(not_found) + " of " + std::to_string(scans.size()) +
                             (not_found == 1 ? " scans was" : " scans were") + " not registered, see above");
}

}  // namespace

void addRegister(CLI::App& app) {
  auto options = std::make_shared<RegisterCommand>();
  Command command(app, "register", kRegisterHelp);
  command
      .texts("inputs", options->inputs,
             "scans (.pcd files or directories of them) or maps to register; last: the map that defines the frame")
      .required()
      .atLeast(2);
  command.numbers("--guess", options->guess, 7, -1e12, 1e12,
                  "pose at which the search for the first scan starts: x y z [m] qx qy qz qw");
  addPoseOptions(command, options->input);
  command.text("--tum", options->tum,
               "TUM file to write, one line per scan: time, x y z [m] qx qy qz qw; the time is that in the name of the "
               "scan, or else the number in its name, or else 0, 1, 2 ...");
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
  command.threads(options->options.threads);
  command.json(options->json);
  command.files({"inputs"}, {".pcd", ".pcd.gz", ".gmap"});
  command.files({"--tum"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
