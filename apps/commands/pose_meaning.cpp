// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pose_meaning.h"

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands/scan_input.h"
#include "core/same_pose.h"
#include "io/scans/keeping_points.h"
#include "registration/pose_check.h"

namespace gaussmap::app {
namespace {

const std::map<std::string, PoseConvention> kConventionNames = {{"sensor-to-map", PoseConvention::SensorToMap},
                                                                {"inverse", PoseConvention::Inverse},
                                                                {"w-first", PoseConvention::WFirst},
                                                                {"w-last", PoseConvention::WLast},
                                                                {"camera", PoseConvention::Camera},
                                                                {"optical", PoseConvention::Optical}};

/// Returns what is wrong with the poses if `better` is right: "if the poses are inverse (map to sensor)".
std::string conditionOf(PoseConvention better) {
  switch (better) {
    case PoseConvention::SensorToMap:
      return "if the poses move points from the sensor frame into the map frame";
    case PoseConvention::NoMotion:
      return "if the points are already in the map frame";
    case PoseConvention::Inverse:
      return "if the poses are inverse (map frame to sensor frame)";
    case PoseConvention::WFirst:
      return "if the quaternions are written with w first (qw qx qy qz)";
    case PoseConvention::WLast:
      return "if the quaternions are written with w last (qx qy qz qw)";
    case PoseConvention::Camera:
      return "if the poses are those of a camera (x right, y down, z forward) on a lidar";
    case PoseConvention::Optical:
      return "if the points have the axes of a camera (x right, y down, z forward) and the poses those of a robot";
  }
  return "";
}

/// Returns what to do: "use --frame map".
std::string adviceFor(PoseConvention better, bool in_map_frame, PoseConvention given) {
  if (better == PoseConvention::NoMotion) return "use --frame map";
  if (in_map_frame && better == given) return "run the command without --frame map";
  if (better == PoseConvention::SensorToMap)
    return std::string("run the command without ") + (in_map_frame ? "--frame map and " : "") + "--pose-convention";
  for (const auto& [name, convention] : kConventionNames)
    if (convention == better) return "use --pose-convention " + name + (in_map_frame ? " without --frame map" : "");
  return "";
}

}  // namespace

void addPoseMeaning(Command& command, PoseMeaning& meaning) {
  command
      .choiceOf("--pose-convention", meaning.convention, kConventionNames,
                R"(what the poses mean: sensor-to-map, or inverse (map to sensor), w-first and w-last (order of the
          quaternion, if it is not the usual one), camera (poses of a camera, points of a lidar, as in
          KITTI), optical (poses of a robot, points of a camera))")
      .rare();
  command
      .flag("!--no-pose-check", meaning.check,
            "do not check whether neighbouring scans fit each other better with another --pose-convention or --frame")
      .rare();
}

PoseFinding checkMeaning(FoundScans& found, const PoseMeaning& meaning, std::optional<PoseConvention> never,
                         int threads) {
  if (!meaning.check) return {};
  FileScans& scans = found.scans;
  detail::PoseCheckOptions options;
  options.convention = meaning.convention;
  options.never = never;
  options.threads = threads;
  options.read = {found.poses_as_read, found.extrinsic};
  detail::PoseCheck check;
  bool fits_without_extrinsic = false;
  try {
    const detail::KeepingPoints keeping(scans);  // the command reads these scans again
    check = checkPoses(scans, options);
    if ((check.better || check.doubtful) && !detail::samePose(found.extrinsic, Pose())) {
      options.read->extrinsic = Pose();
      const detail::PoseCheck without = checkPoses(scans, options);
      fits_without_extrinsic = !without.better && !without.doubtful;
    }
  } catch (const FileError&) {
    return {};  // the command reads the file again and reports it
  }
  const std::string start = nameOf(scans) + ": neighbouring scans do not fit each other: ";
  const std::string end = ", or use --no-pose-check if the poses are right";
  if (fits_without_extrinsic)
    return {nameOf(scans) +
                ": neighbouring scans fit each other only without the extrinsic, so the poses may already be "
                "those of the sensor; use --extrinsic none" +
                end,
            ""};
  if (check.better) {
    const auto& duel = check.duel;
    return {start + std::to_string(duel.first_only + duel.both) + " of " + std::to_string(duel.pieces) +
                " pieces of surface lie on the next scan, but " + std::to_string(duel.other_only + duel.both) + " " +
                conditionOf(*check.better) + "; " +
                adviceFor(*check.better, scans.frame() == ScanFrame::Map, meaning.convention) + end,
            ""};
  }
  if (!check.doubtful) return {};
  const detail::ConventionFit& fit = check.fits[std::size_t(check.given)];
  return {"", start + "only " + std::to_string(fit.on) + " of " + std::to_string(fit.met) +
                  " pieces of surface lie on the next scan. The poses may be wrong, for example their times, units or "
                  "sensor; see \"Wrong poses\" in docs/scans-and-poses.md"};
}

}  // namespace gaussmap::app
