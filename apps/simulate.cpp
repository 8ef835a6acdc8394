// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simulate [SCENE] -o DIR: scans of a built-in world whose surfaces are known exactly.
#include "simulation/simulation.h"

#include <algorithm>
#include <iostream>
#include <map>

#include "common.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/ply/ply.h"
#include "io/scans/scan_names.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const std::map<std::string, WorldName> kWorlds = {{"corner", WorldName::Corner},
                                                  {"street", WorldName::Street},
                                                  {"avenue", WorldName::Avenue},
                                                  {"hall", WorldName::Hall},
                                                  {"plan", WorldName::Plan}};

struct SimulateCommand {
  std::string scene = "corner";
  Output output;
  SimulationOptions world;
  double noise = LidarOptions().noise;
  std::optional<int> rings, columns;
  std::optional<double> field, max_range;
  int threads = 0;
  std::uint64_t seed = 1;
};

void adapt(LidarOptions& lidar, const SimulateCommand& options) {
  if (options.field) throw UsageError("--field-of-view: only the laser of 'plan' has one");
  lidar.rings = options.rings.value_or(lidar.rings);
  lidar.columns = options.columns.value_or(lidar.columns);
}

void adapt(PlanarLaserOptions& laser, const SimulateCommand& options) {
  if (options.rings) throw UsageError("--rings: the laser of 'plan' has one ring");
  laser.beams = options.columns.value_or(laser.beams);
  laser.field_deg = options.field.value_or(laser.field_deg);
}

std::filesystem::path makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw UsageError(folder.string() + ": the directory cannot be made: " + error.message());
  return folder;
}

/// scan00.pcd ... with as many digits as the last of them needs, so that names sort as numbers do.
std::vector<std::filesystem::path> scanPaths(const std::filesystem::path& folder, std::size_t count) {
  const std::size_t digits = std::max<std::size_t>(2, std::to_string(count - 1).size());
  std::vector<std::filesystem::path> paths;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    paths.push_back(folder / ("scan" + std::string(digits - number.size(), '0') + number + ".pcd"));
  }
  return paths;
}

/// Scans that an earlier run left would be taken for scans of this one.
void refuseOtherScans(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& own) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (isScanName(entry.path().filename()) && std::find(own.begin(), own.end(), entry.path()) == own.end())
      throw UsageError(entry.path().string() + " would lie among the new scans: remove it, or take another directory");
}

void writeScan(const std::filesystem::path& path, const SimulatedScan& scan, bool with_labels) {
  std::vector<float> xyz;
  xyz.reserve(3 * scan.points.size());
  for (const Eigen::Vector3d& point : scan.points)
    for (int axis = 0; axis < 3; ++axis) xyz.push_back(static_cast<float>(point(axis)));
  std::vector<std::uint32_t> labels;
  for (const SurfaceLabel label : scan.labels) labels.push_back(static_cast<std::uint32_t>(label));
  std::vector<PcdOutput> fields;
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    fields.push_back(pcdOutput(names[axis], xyz.data() + (xyz.empty() ? 0 : axis), 1, 3 * sizeof(float)));
  if (with_labels) fields.push_back(pcdOutput("label", labels.data()));
  writePcd(path, scan.points.size(), fields, scan.pose);
}

/// The walls of the plan, linked where one begins at the end of the one before.
SegmentMap planMap() {
  SegmentMap map;
  for (const WallSegment& wall : planWalls()) {
    const std::size_t i = map.segments.size();
    Segment segment;
    segment.start = wall.from;
    segment.end = wall.to;
    if (i == 0 || segment.start != map.segments.back().end) map.chains.push_back({i, i, false});
    map.segments.push_back(segment);
    SegmentMap::Chain& chain = map.chains.back();
    chain.last = i + 1;
    chain.closed = map.segments[chain.first].start == segment.end;
  }
  return map;
}

void run(const SimulateCommand& options) {
  if (options.world.moving && options.scene != "street" && options.scene != "avenue")
    throw UsageError("--moving: only in the scenes 'street' and 'avenue'");
  Simulation simulation = makeSimulation(kWorlds.at(options.scene), options.world);
  std::visit(
      [&](auto& sensor) {
        adapt(sensor, options);
        sensor.noise = options.noise;
        sensor.max_range = options.max_range.value_or(sensor.max_range);
        sensor.threads = options.threads;
      },
      simulation.sensor);

  const std::filesystem::path folder = options.output.path, scans = makeFolder(folder / "scans");
  const std::vector<std::filesystem::path> paths = scanPaths(scans, simulation.trajectory.size());
  std::vector<std::filesystem::path> outputs = {folder / "truth.pcd", folder / "truth.ply", folder / "trajectory.tum"};
  const bool has_walls = options.scene == "plan";
  if (has_walls) outputs.push_back(folder / "walls.pcd");
  outputs.insert(outputs.end(), paths.begin(), paths.end());
  for (const std::filesystem::path& path : outputs) checkOutput({path.string(), options.output.force});
  refuseOtherScans(scans, paths);

  std::vector<Vector<3>> truth;
  std::size_t points = 0;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const SimulatedScan scan = simulateScan(simulation, i, options.seed);
    writeScan(paths[i], scan, options.world.moving);
    for (std::size_t j = 0; j < scan.truth.size(); ++j)
      if (scan.labels[j] == SurfaceLabel::Static) truth.push_back(scan.truth[j]);
    points += scan.points.size();
  }
  writePcd(folder / "truth.pcd", truth, PcdPrecision::Double);
  writePly(folder / "truth.ply", simulation.world.mesh());
  writeTum(folder / "trajectory.tum", simulation.trajectory);
  if (has_walls) writeSegmentPcd(folder / "walls.pcd", planMap());
  std::cout << folder.string() << ": " << options.scene << ", " << paths.size()
            << (paths.size() == 1 ? " scan, " : " scans, ") << points << " points";
  if (options.world.moving) std::cout << " (" << points - truth.size() << " on moving objects)";
  std::cout << "; the truth: truth.ply (" << simulation.world.mesh().triangles.size()
            << " triangles), truth.pcd (where rays met them), trajectory.tum"
            << (has_walls ? ", walls.pcd (for gaussmap segments --walls)\n" : "\n");
}

}  // namespace

void addSimulate(CLI::App& app) {
  auto options = std::make_shared<SimulateCommand>();
  CLI::App* command = app.add_subcommand("simulate", "Scans of a built-in scene, with the exact truth beside them");
  command->footer(
      "Scenes: corner (floor, two walls, a pole), street (150 m: plane fronts, trees, poles, parked cars, a fence),\n"
      "avenue (the same with fronts in relief and many trees), hall (a hall, a corridor, furnished rooms), plan (a\n"
      "floor plan with walls of 12 cm for a planar laser).\n"
      "Writes DIR/scans/scan00.pcd ... (sensor frame, pose in VIEWPOINT; with --moving a field label: 1 = on a moving\n"
      "object) and, in the map frame, DIR/truth.ply (all that stands still; the rays are cast against these very\n"
      "triangles), DIR/truth.pcd (where they met them, without noise) and DIR/trajectory.tum; plan also "
      "DIR/walls.pcd,\n"
      "its walls as a map of segments.\n"
      "Example: gaussmap simulate street -o street --moving && gaussmap pcd2map street/scans -o street.gmap");
  command->add_option("scene", options->scene, "what to scan")->check(CLI::IsMember(kWorlds))->capture_default_str();
  addOutput(*command, options->output, "directory to write to");
  command
      ->add_option("--scans", options->world.scans, "scans, spread over the same way; default: 5, 20, 30, 240 by scene")
      ->check(CLI::Range(1, 100000));
  command->add_flag("--moving", options->world.moving, "three cars drive and two pedestrians walk through the street");
  command->add_option("--noise", options->noise, "standard deviation of the ranges [m]")
      ->check(numberBetween(0.0, 1e3))
      ->capture_default_str();
  command->add_option("--rings", options->rings, "lasers of the lidar; default: 32, street 64")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--columns", options->columns,
                   "directions in a turn, or beams of the planar laser; default: 1800, plan 361")
      ->check(CLI::Range(1, 100000));
  command->add_option("--field-of-view", options->field, "of the planar laser [degree]; default: 180")
      ->check(numberBetween(1.0, 360.0));
  command->add_option("--max-range", options->max_range, "of the sensor [m]; default: 60, street 80, plan 30")
      ->check(numberBetween(1e-3, 1e9));
  addSeed(*command, options->seed, "of the noise");
  addThreads(*command, options->threads);
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
