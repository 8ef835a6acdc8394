// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// The points of a PCD file with all their fields, including fields that gaussmap does not use. The points can be
/// filtered, moved and written again.
struct PcdRecords {
  std::vector<PcdField> fields;  ///< in the order of the file
  std::size_t record_size = 0;   ///< bytes per point
  std::vector<char> bytes;       ///< size() * record_size, fields at their offsets
  std::size_t width = 0;         ///< points per row of an organised cloud; 0: not organised
  Pose viewpoint;

  std::size_t size() const { return record_size > 0 ? bytes.size() / record_size : 0; }
};

/// Checks that the fields of a file can be written again. Throws FileError with the name of a field for which this is
/// impossible, for example because PCL has no floats of 3 bytes.
GAUSSMAP_API void checkWritable(const PcdReader& reader);

/// Reads all points of a file. Throws FileError like PcdReader::records().
GAUSSMAP_API PcdRecords readRecords(const PcdReader& reader);

/// Removes the points whose flag is not set. In an organised cloud they stay, but their x, y and z become NaN, as in
/// PCL's filters. Throws std::invalid_argument unless there is one flag per point.
GAUSSMAP_API void keepOnly(PcdRecords& records, const std::vector<bool>& keep);

/// Returns true if x, y and z are floats (F 4).
GAUSSMAP_API bool hasFloatCoordinates(const PcdRecords& records);

/// Converts x, y, z to doubles (F 8), if they are floats. The other fields keep their types.
GAUSSMAP_API void widenCoordinates(PcdRecords& records);

/// Transforms x, y, z by R p + t, and rotates normal_x, normal_y, normal_z if the cloud has them. The viewpoint becomes
/// the identity. If floats would round a moved coordinate by more than `precision` [m], x, y, z become doubles. The
/// types of the other fields do not change.
GAUSSMAP_API void moveToMap(PcdRecords& records, const Pose& pose, double precision);

/// Appends points that have the same fields. If x, y, z are floats in one cloud and doubles in the other, they become
/// doubles. Throws std::invalid_argument if the fields differ in another way.
GAUSSMAP_API void append(PcdRecords& records, PcdRecords more);

/// Writes a binary PCD file atomically and without padding. Throws FileError if it cannot be written.
GAUSSMAP_API void writePcd(const std::filesystem::path& path, const PcdRecords& records);

}  // namespace gaussmap::detail
