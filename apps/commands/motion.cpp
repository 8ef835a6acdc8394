// SPDX-License-Identifier: BSD-3-Clause
#include "commands/motion.h"

#include <charconv>
#include <sstream>

#include "common/command.h"
#include "gaussmap/io/scans/pose_file.h"

namespace gaussmap::app {
namespace {

double numberIn(const std::string& option, const std::string& word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw UsageError(option + ": '" + word + "' is not a number");
  return value;
}

std::vector<double> numbersIn(const std::string& option, const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) numbers.push_back(numberIn(option, word));
  return numbers;
}

Pose poseIn(const std::string& text) {
  const std::vector<double> n = numbersIn("--transform", text);
  if (n.size() != 7)
    throw UsageError("--transform '" + text + "': " + std::to_string(n.size()) +
                     " numbers found, expected the seven of x y z qx qy qz qw, in quotes");
  const Pose pose{{n[0], n[1], n[2]}, Pose::Rotation(n[6], n[3], n[4], n[5])};
  const std::string fault = poseFault(pose);
  if (!fault.empty()) throw UsageError("--transform '" + text + "': " + fault);
  return normalised(pose);
}

PoseCovariance covarianceIn(const std::string& text) {
  const std::vector<double> n = numbersIn("--pose-covariance", text);
  PoseCovariance covariance = PoseCovariance::Zero();
  if (n.size() == 6)
    for (Eigen::Index i = 0; i < 6; ++i) covariance(i, i) = n[static_cast<std::size_t>(i)];
  else if (n.size() == 36)
    for (Eigen::Index i = 0; i < 36; ++i) covariance(i / 6, i % 6) = n[static_cast<std::size_t>(i)];
  else
    throw UsageError("--pose-covariance: " + std::to_string(n.size()) +
                     " numbers found, expected the 36 of a matrix or the 6 of its diagonal");
  return covariance;
}

}  // namespace

void addMotionOptions(Command& command, MotionInput& input) {
  const Option transform = command
                               .texts("--transform", input.transforms,
                                      "pose of a map in the target frame, \"x y z qx qy qz qw\" [m]; one per moved map")
                               .onePerUse();
  command
      .text("--transform-file", input.file,
            "file of poses, in place of --transform, one line per moved map: TUM, KITTI, or map name and pose")
      .excludes(transform);
  command
      .text("--pose-covariance", input.covariance,
            R"(covariance of each given pose, which widens the moved Gaussians, in quotes: 6 x 6 numbers for x y z [m]
            and the rotations about x y z [rad], or only the 6 numbers of the diagonal)")
      .rare();
  command.files({"--transform-file"});
}

Motions motionsOf(const MotionInput& input, const std::vector<std::filesystem::path>& maps) {
  Motions motions;
  std::vector<Pose>& poses = motions.poses;
  if (!input.file.empty()) {
    poses = posesForScans(readPoseFile(input.file), maps);
  } else {
    for (const std::string& text : input.transforms) poses.push_back(poseIn(text));
    if (!poses.empty() && poses.size() != maps.size())
      throw UsageError("--transform: given " + std::to_string(poses.size()) + " times for " +
                       std::to_string(maps.size()) + (maps.size() == 1 ? " map" : " maps") +
                       " to move, expected once per map");
  }
  if (poses.empty() && !input.covariance.empty())
    throw UsageError("--pose-covariance: needs --transform or --transform-file");
  if (!input.covariance.empty()) motions.covariance = covarianceIn(input.covariance);
  return motions;
}

}  // namespace gaussmap::app
