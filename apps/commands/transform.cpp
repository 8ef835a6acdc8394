// SPDX-License-Identifier: BSD-3-Clause
// gaussmap transform MAP -o OUT --transform "x y z qx qy qz qw": moves a map into another frame.
#include <memory>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "commands/motion.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/editing/transform_map.h"

namespace gaussmap::app {
namespace {

struct TransformCommand : MapTaskOptions {
  MotionInput motion;
  bool inverse = false;
};

const Help kTransformHelp = {
    "Move a map into another frame",
    R"(gaussmap transform room.gmap -o house.gmap --transform "4 0 2.7 0 0 0.7071 0.7071")",
    R"(Every Gaussian is moved into the cell that contains its new mean. The result has no moments, so it accepts no
more scans. Moving it back (--inverse) restores the means and weights of the finest scale.)"};

template <int D>
void run(const TransformCommand& command) {
  std::vector<std::filesystem::path> inputs = {command.map};
  if (!command.motion.file.empty()) inputs.emplace_back(command.motion.file);
  MapTask task(command, inputs);
  const Motions motions = motionsOf(command.motion, {command.map});
  if (motions.poses.empty()) throw UsageError("transform needs --transform or --transform-file");
  const Pose& given = motions.poses.front();
  TransformOptions options;
  options.threads = command.threads;
  options.covariance = motions.covariance;
  if (command.inverse && options.covariance) options.covariance = covarianceOfInverse(given, *options.covariance);
  const GaussianMap<D> map = transformMap<D>(task.load<D>(), command.inverse ? given.inverse() : given, options);

  Json step = {{"inverse", command.inverse}};
  const Eigen::Quaterniond q(given.rotation.toRotationMatrix());
  const Eigen::Vector3d& t = given.translation;
  step["transform"] = {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
  if (!command.motion.covariance.empty()) step["pose_covariance"] = command.motion.covariance;
  if (task.metadata.erase(kCoordinateSystemEntry) > 0)
    note("the moved map has no coordinate reference system any more");
  task.addStep("transform", step);
  task.save(map);
  task.report(map);
}

}  // namespace

void addTransform(CLI::App& app) {
  auto options = std::make_shared<TransformCommand>();
  Command command(app, "transform", kTransformHelp);
  addMapToMap(command, *options);
  addMotionOptions(command, options->motion);
  command.flag("--inverse", options->inverse, "apply the inverse of the given pose");
  addRunOptions(command, *options);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
