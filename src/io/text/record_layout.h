// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/column_samples.h"
#include "io/text/point_fields.h"

namespace gaussmap::detail {

/// The fields of a raw record and their places.
struct RecordLayout {
  explicit RecordLayout(std::vector<PointField> record_fields);

  std::vector<PointField> fields;
  std::vector<std::size_t> offsets;  ///< bytes from the start of the record
  std::size_t size = 0;              ///< bytes per record
};

/// Returns a list of fields with types, for messages: "x:f32 y:f32 z:f32 ring:u16".
std::string describe(const RecordLayout& layout);

/// Reads one field of `count` records into `values`. `bytes` must hold the records.
void readField(const RecordLayout& layout, std::size_t field, std::string_view bytes, std::size_t first,
               std::size_t count, double* values);

/// Reads records that are spread over the file.
std::vector<ColumnSample> sampleRecords(const RecordLayout& layout, std::string_view bytes);

/// Finds the fields of a file of KITTI or nuScenes. Throws FileError if its size or its content does not fit, or if
/// both fit; the message names the option.
std::vector<PointField> guessRecord(const std::filesystem::path& path, std::string_view bytes);

/// Returns the fields that guessRecord() finds by the content alone; empty if neither or both kinds fit.
std::string likelyRecord(std::string_view bytes);

/// Throws FileError if the first bytes are those of a text or of another kind of file.
void refuseOtherKinds(const std::filesystem::path& path, std::string_view bytes);

}  // namespace gaussmap::detail
