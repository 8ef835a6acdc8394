// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "io/formats/message_file.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Where the poses of the scans of a recording come from.
enum class BagPoses {
  Automatic,  ///< tf if a moving transform connects the sensor with a fixed frame, else the only topic of odometry
  Tf,         ///< /tf and /tf_static
  Topic,      ///< BagOptions::pose_topic
  None        ///< no poses: they come from elsewhere
};

/// Options of openBagScans().
struct BagOptions {
  std::string topic;                     ///< of the scans; empty: see chooseScanTopic()
  BagPoses poses = BagPoses::Automatic;  ///< where the poses come from
  std::string pose_topic;                ///< Odometry, Path, PoseStamped, PoseWithCovarianceStamped, TransformStamped
  std::string pose_frame;                ///< whose poses these are; empty: child_frame_id, else the sensor frame
  std::string fixed_frame;               ///< empty: of tf: map, else odom, else the root; of a topic: its frame_id
  std::optional<double> max_time_gap = {};  ///< [s]; default: see openBagScans()
  bool log_times = false;                   ///< use the times of recording instead of those in the headers
};

/// Opens the scans of a recording. Reads all messages of the topic once, and those with poses; keeps no points.
///
/// The time of a scan is header.stamp, or the time of recording if the stamp is zero. Its name is the topic and this
/// time: "/points 1700000000.100000000".
///
/// The pose is that of the sensor frame (header.frame_id of the scan) in the fixed frame, at the time of the scan:
/// - From tf: each transform is interpolated between its neighbours in time. These are at most 1 s apart by default.
///   There is no extrapolation, except by 1 ms, because some programs round times. With max_time_gap, both limits are
///   max_time_gap. A transform that never changes is valid at all times.
/// - From a topic: interpolated between the two messages around the scan, if they are at most four limits apart; else
///   the nearest message, at most one limit away. The limit is max_time_gap, by default half of the median interval
///   between scans. Of a nav_msgs/Path, the last message counts. The transform from the pose's frame to the sensor
///   frame comes from tf, if there is one.
/// - If the points are in the fixed frame already, the pose is the identity.
///
/// A scan without a pose has none in its info(); missingPoses() gives their number and the reason for the first one, or
/// says why the recording has no poses.
///
/// Throws FileError in these cases:
/// - The topic of the scans or of the poses is missing, of a wrong type, or not clear. The message lists the topics.
/// - The poses must come from tf, but no transforms connect the frames. The message lists the frames.
/// - A message is damaged.
std::unique_ptr<ScanFile> openBagScans(std::unique_ptr<MessageFile> file, const std::filesystem::path& path,
                                       const BagOptions& options = {});

}  // namespace gaussmap::detail
