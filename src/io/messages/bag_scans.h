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
  std::string pose_frame;                ///< frame of the poses; empty: child_frame_id, else the sensor frame
  std::string fixed_frame;               ///< empty: for tf map, else odom, else the root; for a topic its frame_id
  std::optional<double> max_time_gap = {};  ///< [s]; default: see openBagScans()
  bool log_times = false;                   ///< use the times of recording instead of those in the headers
  bool has_extrinsic = false;               ///< the caller knows the pose of the sensor in the frame of the poses
  bool points_in_map = false;  ///< the points are in the map frame; the poses give only the positions of the sensor
};

/// Opens the scans of a recording. Reads all messages of the topic once, and those with poses; keeps no points.
///
/// The time of a scan is header.stamp, or the time of recording if the stamp is zero. Its name is the topic and this
/// time: "/points 1700000000.100000000".
///
/// The pose is that of the sensor frame (header.frame_id of the scan) in the fixed frame, at the time of the scan:
/// - From tf: each transform is interpolated between its neighbours in time, which are at most 1 s apart. There is no
///   extrapolation, except by 1 ms, because some programs round times. A transform that never changes is valid at all
///   times. With pose_frame and has_extrinsic, it is the pose of that frame.
/// - From a topic: interpolated between the two messages around the scan, if they are at most twice the median interval
///   between scans apart; else the nearest message, if it is at most half of this interval away. Of a nav_msgs/Path,
///   the last message counts. The transform from the pose's frame to the sensor frame comes from tf, unless
///   has_extrinsic is set.
/// - If the frame of the scans is a fixed frame (map, odom, world, earth or camera_init, also with a namespace), or the
///   frame of the poses, the points are not moved by the poses of the sensor, and inMapFrame() is true. With
///   points_in_map, the poses are then the positions of the sensor.
///
/// If max_time_gap is set, the nearest pose counts if it is at most that far away, and neighbours may also be up to
/// twice this gap apart. There is a warning if poses were taken without interpolation.
///
/// A scan without a pose has none in its info(), and missingPoses() says why. With BagPoses::None and a pose_frame,
/// FileScanInfo::sensor_in_pose_frame is the pose of the sensor in this frame, from tf.
///
/// Throws FileError in these cases:
/// - The topic of the scans or of the poses is missing, of a wrong type, or not clear. The message lists the topics.
/// - A frame that the options name is missing, or no transforms connect the frames. The message lists the frames.
/// - The poses are those of another frame, and the pose of the sensor in this frame is unknown.
/// - The times in the headers step back, for example because simulated time was reset.
/// - A message is damaged.
std::unique_ptr<ScanFile> openBagScans(std::unique_ptr<MessageFile> file, const std::filesystem::path& path,
                                       const BagOptions& options = {});

}  // namespace gaussmap::detail
