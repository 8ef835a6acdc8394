// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Options of openFloatRecords().
struct FloatRecordsOptions {
  /// Fields of a record, for example "x y z intensity ring:u16 time:f64". Types: f32 (default) f64 u8 u16 u32 i8 i16
  /// i32. "-:f32" skips a field; "x:i32:mm" and "time:u32:ns" give units. Empty: found from the content.
  std::string fields;
};

/// Opens a file of raw little-endian records without a header, such as the .bin files of KITTI and nuScenes.
///
/// Without options.fields, the records are 4 floats (x y z intensity, KITTI) or 5 floats (x y z intensity ring,
/// nuScenes). The content decides: finite coordinates below 10 km, an intensity from 0 to 1, or whole from 0 to 255,
/// and a whole ring from 0 to 127. If both fit, the ending .pcd.bin of nuScenes decides.
///
/// Throws FileError if neither or both fit, if the size is not a multiple of the record, or if the first bytes are
/// those of another kind of file. Throws std::invalid_argument if options.fields is not valid.
std::unique_ptr<ScanFile> openFloatRecords(const std::filesystem::path& path, const FloatRecordsOptions& options = {});

}  // namespace gaussmap::detail
