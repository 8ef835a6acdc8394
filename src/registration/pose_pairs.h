// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// All conventions, in the order of PoseConvention.
inline constexpr std::array<PoseConvention, 7> kPoseConventions = {
    PoseConvention::SensorToMap, PoseConvention::NoMotion, PoseConvention::Inverse, PoseConvention::WFirst,
    PoseConvention::WLast,       PoseConvention::Camera,   PoseConvention::Optical};

/// Where a scan lies in the frame of its points, and how large it is.
struct ScanExtent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0.0;                               ///< median distance of its points from the centre [m]
};

/// Poses as they were read, and the pose of the sensor in the frame that they describe.
struct ReadPoses {
  std::vector<Pose> poses;
  Pose extrinsic;
};

/// Returns the motion that moves points of scan `from` into the frame of scan `to`, if the poses mean `convention`.
Pose motionBetween(PoseConvention convention, const ReadPoses& read, std::size_t to, std::size_t from);

/// Returns how far two motions of a scan are apart [m]: the distance of the moved centres, and the length of the arc at
/// the radius of the scan.
double separation(const Pose& a, const Pose& b, const ScanExtent& extent);

/// Returns pairs of neighbouring scans that show which convention the poses have: the motions of a pair differ clearly
/// between the conventions, but the scans are near enough to overlap.
///
/// `given` is the convention that the program assumes. The pairs are spread over the sequence, at most `most`. A pair
/// is left out if all conventions give nearly the same motion.
std::vector<std::pair<std::size_t, std::size_t>> tellingPairs(const ReadPoses& read, PoseConvention given,
                                                              const ScanExtent& extent, std::size_t most);

}  // namespace gaussmap::detail
