// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/pose_checks.h"

#include <algorithm>
#include <sstream>

#include "core/same_pose.h"

#include "io/files/written_position.h"

namespace gaussmap::detail {
namespace {

// Earth-centred coordinates are below 1e7 m, so a position beyond this is not in metres.
constexpr double kFarthest = 1e8;
constexpr const char* kWayOut =
    "Give each scan its pose in the VIEWPOINT of its header or with --poses FILE, or use --frame map if "
    "the points are already in the map frame.";

std::string describe(const Pose& pose) {
  std::ostringstream text;
  const Eigen::Vector3d& t = pose.translation;
  const Pose::Rotation& q = pose.rotation;
  text << "(" << t.x() << " " << t.y() << " " << t.z() << ", quaternion w x y z " << q.w() << " " << q.x() << " "
       << q.y() << " " << q.z() << ")";
  return text.str();
}

using ScanPoses = std::vector<const ScanPose*>;

ScanPoses scansAt(const Pose& pose, const std::vector<ScanPose>& scans) {
  ScanPoses found;
  for (const ScanPose& scan : scans)
    if (samePose(scan.pose, pose) && !scan.in_map_frame) found.push_back(&scan);
  return found;
}

/// Returns true if the scans do not all hold the same cloud. The same cloud may have the same pose.
bool cloudsDiffer(const ScanPoses& scans) {
  return std::any_of(scans.begin(), scans.end(),
                     [&scans](const ScanPose* scan) { return scan->fingerprint != scans.front()->fingerprint; });
}

void warnOfIdenticalPoses(const std::vector<ScanPose>& scans, PoseDiagnosis& diagnosis) {
  if (scans.empty()) return;
  const ScanPoses like_first = scansAt(scans.front().pose, scans);
  if (like_first.empty()) return;  // points in the map frame
  if (like_first.size() == scans.size()) {
    if (cloudsDiffer(like_first))
      diagnosis.same_pose = "all " + std::to_string(scans.size()) + " scans have the same pose " +
                            describe(scans.front().pose) + " but their points differ. " + kWayOut;
    return;
  }
  const ScanPoses at_identity = scansAt(Pose{}, scans);
  if (at_identity.size() < 2 || !cloudsDiffer(at_identity)) return;
  diagnosis.warnings.push_back(
      std::to_string(at_identity.size()) + " of " + std::to_string(scans.size()) +
      " scans have no pose of their own (the identity) but their points differ: " + at_identity[0]->label() + ", " +
      at_identity[1]->label() + (at_identity.size() > 2 ? " ... " : ". ") + kWayOut);
}

void warnOfFarPoses(const std::vector<ScanPose>& scans, PoseDiagnosis& diagnosis) {
  ScanPoses far;
  for (const ScanPose& scan : scans)
    if (scan.pose.translation.norm() > kFarthest) far.push_back(&scan);
  if (far.empty()) return;
  std::ostringstream text;
  text << far.front()->label() << ": the sensor is " << far.front()->pose.translation.norm()
       << " m from the origin of the map";
  if (far.size() > 1) text << ", and " << far.size() - 1 << " more are beyond " << kFarthest << " m";
  text << ". Poses must be in metres.";
  diagnosis.warnings.push_back(text.str());
}

void warnOfRoundedPoses(const std::vector<ScanPose>& scans, PoseDiagnosis& diagnosis) {
  RoundedPositions positions;
  const ScanPose* first = nullptr;
  for (const ScanPose& scan : scans) {
    const Eigen::Vector3d& t = scan.pose.translation;
    positions.add(scan.position_step, t.x(), t.y(), t.z());
    if (first == nullptr && scan.position_step > 0.0) first = &scan;
  }
  if (first == nullptr) return;
  if (const std::string warning = positions.warning(); !warning.empty())
    diagnosis.warnings.push_back(first->path.string() + " and others: VIEWPOINT: " + warning);
}

}  // namespace

void dropUnneededRotations(std::vector<ScanPose>& scans, std::vector<std::string>& warnings) {
  std::size_t dropped = 0;
  std::string first;
  for (ScanPose& scan : scans) {
    const std::string fault = poseFault(scan.pose);
    if (fault.empty()) continue;
    if (dropped++ == 0) first = scan.label() + ": " + fault;
    scan.pose.rotation = Pose::Rotation::Identity();
    if (!scan.pose.translation.allFinite()) scan.pose.translation.setZero();
  }
  if (dropped == 0) return;
  const std::string more = dropped > 1 ? " (and " + std::to_string(dropped - 1) + " more)" : "";
  warnings.push_back(first + more +
                     "; only the position in VIEWPOINT is used, because the points are in the map frame");
}

PoseDiagnosis diagnosePoses(const std::vector<ScanPose>& scans) {
  for (const ScanPose& scan : scans)
    if (const std::string fault = poseFault(scan.pose); !fault.empty())
      throw FileError(scan.path, (scan.name.empty() ? "" : scan.name + ": ") + fault);
  PoseDiagnosis diagnosis;
  warnOfIdenticalPoses(scans, diagnosis);
  warnOfFarPoses(scans, diagnosis);
  warnOfRoundedPoses(scans, diagnosis);
  return diagnosis;
}

}  // namespace gaussmap::detail
