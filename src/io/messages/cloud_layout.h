// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "io/messages/ros_messages.h"

namespace gaussmap::detail {

/// Where the numbers of one element of a field are, for all points of a sensor_msgs/PointCloud2.
struct CloudColumn {
  std::string name;        ///< "x", "intensity"; "normal[0]" if the field has several elements
  std::size_t offset = 0;  ///< from the start of a point [bytes]
  NumberType type = NumberType::Float32;
};

/// The layout of the data of a sensor_msgs/PointCloud2, checked against their size.
struct CloudLayout {
  std::size_t points = 0;
  std::size_t width = 0;       ///< points per row, at least 1 if there are points
  int columns = 0;             ///< points per row of an organised cloud, or 0
  std::size_t point_step = 0;  ///< from point to point [bytes]
  std::size_t row_step = 0;    ///< from row to row [bytes]
  bool swapped = false;        ///< the numbers have the other byte order than this computer
  std::array<CloudColumn, 3> axes;
  std::vector<CloudColumn> values;  ///< all other fields, with unique names
};

/// Checks and returns the layout of a cloud. The names of the values are those of the fields. The first of the fields
/// time, t, timestamp, time_stamp, offset_time and time_offset that exists becomes the value "time".
///
/// A cloud without points needs no fields. Throws FileError with the topic and the time of the message in these cases:
/// - width, height, point_step and row_step contradict the size of the data.
/// - x, y or z is missing, occurs twice, or is not float32 or float64.
/// - A field ends outside of the points, or has an unknown datatype.
CloudLayout layoutOf(const CloudMessage& cloud, const MessageOrigin& origin);

}  // namespace gaussmap::detail
