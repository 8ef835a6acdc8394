// SPDX-License-Identifier: BSD-3-Clause
// gaussmap transform MAP -o OUT --transform "x y z qx qy qz qw": a map in another frame.
#include <iostream>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "motion.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct TransformCommand {
  std::string map;
  Output output;
  MotionInput motion;
  bool inverse = false, json = false;
  TransformOptions transform;
};

void run(const TransformCommand& options) {
  std::vector<std::filesystem::path> inputs = {options.map};
  if (!options.motion.file.empty()) inputs.push_back(options.motion.file);
  checkMapOutput(options.output, inputs);
  const std::vector<RigidMotion<3>> motions = motionsOf(options.motion, {options.map});
  if (motions.empty()) throw UsageError("transform needs --transform or --transform-file");
  const double start = now();
  MapMetadata metadata;
  const GaussianMap<3> old = loadAnyMap(options.map, &metadata);
  const RigidMotion<3> motion = options.inverse ? motions.front().inverse() : motions.front();
  const GaussianMap<3> map = transformMap<3>(old, motion, options.transform);

  metadata.erase("error_curves");  // of the scales as they were
  Json step = {{"command", "transform"}, {"version", GAUSSMAP_VERSION}, {"inverse", options.inverse}};
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(motions.front().rotation));
  const Eigen::Vector3d& t = motions.front().translation;
  step["transform"] = {t.x(), t.y(), t.z(), rotation.x(), rotation.y(), rotation.z(), rotation.w()};
  if (!options.motion.covariance.empty()) step["pose_covariance"] = options.motion.covariance;
  addHistory(metadata, step);
  saveMap<3>(map, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.transform.threads});
  reportMap(options.output.path, map, perScale(map), start, options.json);
}

}  // namespace

void addTransform(CLI::App& app) {
  auto options = std::make_shared<TransformCommand>();
  CLI::App* command = app.add_subcommand("transform", "Move a map into another frame");
  command->footer(
      "Every Gaussian is moved and sorted into the cell of its mean. The result holds Gaussians and takes no more "
      "scans;\n"
      "moving it back (--inverse) gives every mean and every weight of the finest scale again.\n"
      "Example: gaussmap transform room.gmap -o house.gmap --transform \"4 0 2.7 0 0 0.7071 0.7071\"");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  addMotionOptions(*command, options->motion);
  command->add_flag("--inverse", options->inverse, "the other way: from the target frame into the map's");
  addThreads(*command, options->transform.threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
