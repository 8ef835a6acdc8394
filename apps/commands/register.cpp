// SPDX-License-Identifier: BSD-3-Clause
// gaussmap register: finds the poses of scans, or of other maps, in the frame of a map.
#include <cmath>
#include <cstdio>
#include <memory>

#include "commands/commands.h"
#include "commands/scan_input.h"
#include "common/command.h"
#include "common/json.h"
#include "core/accept_points.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/registration/registration.h"
#include "simulation/trajectory.h"

namespace gaussmap::app {
namespace {

const Help kRegisterHelp = {
    "Find the poses of scans or other maps in the frame of a map",
    "gaussmap register scans/ street.gmap --tum poses.tum",
    R"(Prints one line per scan: its pose (x y z qx qy qz qw), the standard deviations of the pose, and the fitness.
The fitness is the share of the scan that lies on the map, from 0 to 1. The search for the first scan starts at
--guess. Without --guess, it starts at the VIEWPOINT in the header of the file. The search for each later scan starts
at the pose found for the scan before. "degenerate" means that some direction is unobservable, for example along a
corridor.

Maps can be given in place of scans. If the first input is a map and there is no --guess, its search starts at the
identity: the map is not moved.)"};

struct RegisterCommand {
  std::vector<std::string> inputs;  // scans or maps; the last one is the map to register with
  std::vector<double> guess;        // x y z qx qy qz qw; empty: the VIEWPOINT of the first scan; identity for a map
  ScanInput limits;                 // only the ranges
  std::string tum;
  bool force = false;
  RegistrationOptions options;
  bool json = false;
};

Pose guessOf(const RegisterCommand& command, const std::filesystem::path& first) {
  Pose guess;
  if (command.guess.empty()) {
    if (isMap(first)) return guess;
    guess = PcdReader(first).header().viewpoint;
    if (const std::string fault = poseFault(guess); !fault.empty())
      throw FileError(first, "its VIEWPOINT cannot be the first guess: " + fault + "; use --guess");
    return normalised(guess);
  }
  const std::vector<double>& g = command.guess;
  guess = {{g[0], g[1], g[2]}, Pose::Rotation(g[6], g[3], g[4], g[5])};
  if (const std::string fault = poseFault(guess); !fault.empty()) throw UsageError("--guess: " + fault);
  return normalised(guess);
}

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

RegistrationResult registerFile(const std::filesystem::path& path, const GaussianMap<3>& map, const Pose& guess,
                                const RegisterCommand& command) {
  if (isMap(path)) return registerMap(loadAny(path), map, guess, command.options);
  const PcdScans scans({{path, Pose()}});
  Scan scan = scans.read(0);
  warnOfCoordinates(scans, map.grid().side(0));
  detail::dropPoints(detail::limitsOf(accumulateOptions(command.limits, map.grid().side(0), 0)), scan);
  return registerScan(scan.points, map, guess, command.options);
}

void run(const RegisterCommand& command) {
  const std::filesystem::path map_path = command.inputs.back();
  const std::vector<std::filesystem::path> scans = listScans({command.inputs.begin(), std::prev(command.inputs.end())});
  if (!command.tum.empty()) {
    std::vector<std::filesystem::path> inputs = scans;
    inputs.push_back(map_path);
    checkOutput({command.tum, command.force}, inputs);
    refuseOtherKinds(command.tum, "a file of poses", {".tum", ".txt", ".csv"});
  }
  Pose guess = guessOf(command, scans.front());
  const GaussianMap<3> map = loadAny(map_path);
  if (map.empty()) throw FileError(map_path, "the map is empty, so no scan can be registered with it");

  Json all = Json::array();
  std::vector<TimedPose> trajectory;
  for (const std::filesystem::path& path : scans) {
    const RegistrationResult result = registerFile(path, map, guess, command);
    if (result.fitness == 0.0)
      throw FileError(path, "no part of it lies on the map after the search; use a better --guess");
    guess = result.pose;  // for the next scan
    trajectory.push_back({double(trajectory.size()), result.pose});
    if (command.json)
      all.push_back(jsonOf(path, result));
    else
      print(path, result);
  }
  if (!command.tum.empty()) writeTum(command.tum, trajectory);
  if (command.json) printJson(all);
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
  command.text("--tum", options->tum,
               "TUM file to write, one line per scan: number of the scan (from 0), x y z [m] qx qy qz qw");
  command.force(options->force, "replace an existing file of poses");
  command
      .number("--scan-resolution", options->options.resolution, 0.0, 1e6,
              "side of the cells whose Gaussians represent the scan [m], 0 = side of the finest cells of the map")
      .rare();
  command
      .number("--kernel", options->options.kernel, 1e-3, 1e6,
              "robust kernel: halves the cost of a residual of this many standard deviations")
      .rare();
  addRangeOptions(command, options->limits);
  command.threads(options->options.threads);
  command.json(options->json);
  command.files({"inputs"}, {".pcd", ".pcd.gz", ".gmap"});
  command.files({"--tum"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
