// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap::detail {

/// The points of a PCD file with all their fields, also those gaussmap knows nothing of: to be thinned out, moved, and
/// written again.
struct PcdRecords {
  std::vector<PcdField> fields;  ///< in the order of the file
  std::size_t record_size = 0;   ///< bytes a point
  std::vector<char> bytes;       ///< size() * record_size, fields at their offsets
  std::size_t width = 0;         ///< points a row of an organised cloud; 0: in no order
  Pose viewpoint;

  std::size_t size() const { return record_size > 0 ? bytes.size() / record_size : 0; }
};

/// Throws FileError, naming the field, if the fields of a file cannot be written again: PCL has no floats of 3 bytes.
void checkWritable(const PcdReader& reader);

/// Throws FileError as PcdReader::records().
PcdRecords readRecords(const PcdReader& reader);

/// Takes out the points whose flag is not set. In an organised cloud they stay, x, y and z NaN, as PCL's filters do it.
/// Throws std::invalid_argument unless there is one flag a point.
void keepOnly(PcdRecords& records, const std::vector<bool>& keep);

/// Moves x, y, z by R p + t and turns normal_x, normal_y, normal_z, where there are such; the viewpoint becomes the
/// identity. Coordinates keep their type.
void moveToMap(PcdRecords& records, const Pose& pose);

/// Appends points of the same fields. Throws std::invalid_argument if the fields differ.
void append(PcdRecords& records, const PcdRecords& more);

/// Writes a binary PCD file, whole or not at all. Padding is left out. Throws FileError if it cannot be written.
void writePcd(const std::filesystem::path& path, const PcdRecords& records);

}  // namespace gaussmap::detail
