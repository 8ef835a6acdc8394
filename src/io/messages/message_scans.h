// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"
#include "io/formats/message_file.h"
#include "io/messages/ros_messages.h"

// Scans that are one message each.
namespace gaussmap::detail {

/// Returns true if scanSize() and readScan() read this type: sensor_msgs/PointCloud2, LaserScan and PointCloud.
bool isScanType(const std::string& type);

/// Returns true for sensor_msgs/PointCloud2.
bool isCloudType(const std::string& type);

/// What a message says about its scan, without the points.
struct MessageScanSize {
  MessageHeader header;
  std::size_t points = 0;
  bool has_unused_points = false;  ///< a cloud of one row whose data hold more points than width says
  bool has_range_limits = true;    ///< false: a LaserScan whose range_max is not greater than range_min
};

/// Returns the header and the number of points of a scan. Throws FileError if the message is damaged.
MessageScanSize scanSize(const std::string& type, std::string_view message, MessageEncoding encoding,
                         const MessageOrigin& origin);

/// Does the same with the first bytes of a sensor_msgs/PointCloud2. Returns std::nullopt if they are too few or
/// damaged: then scanSize() needs the whole message.
std::optional<MessageScanSize> scanSizeOfStart(const MessageStart& start, MessageEncoding encoding,
                                               const MessageOrigin& origin);

/// Returns a reader of the points and values of a scan, which owns the message. Throws FileError if the message is
/// damaged.
///
/// - sensor_msgs/PointCloud2: the values are all fields except x, y and z. The numbers are not changed, so the unit of
///   "time" is that of the driver: [s] for Velodyne, [ns] since the start of the scan for Ouster and Livox, [s] since
///   1970 for Hesai and RoboSense. "rgb" can be a float that holds the bytes of a colour, as in PCL.
/// - sensor_msgs/LaserScan: the points are in the plane z = 0. A point whose range is not finite or is outside of
///   range_min to range_max is NaN. The values are "intensity", if there is one per range, and "time" [s], if
///   time_increment is not 0.
/// - sensor_msgs/PointCloud: the values are the channels.
std::unique_ptr<ScanReader> readScan(const std::string& type, std::vector<char> message, MessageEncoding encoding,
                                     const MessageOrigin& origin);

}  // namespace gaussmap::detail
