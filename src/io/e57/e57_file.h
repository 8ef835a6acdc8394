// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Returns true if a file starts like an E57 file (ASTM E2807). The first 8 bytes are enough.
bool isE57(std::string_view start);

/// Opens an E57 file. Reads the header and the XML section, and checks the sections of points against the size of the
/// file. Throws FileError if this fails.
///
/// Each entry of data3D is a scan. The details:
/// - Pose: the one in the file, as it is written. The caller checks it with poseFault(). A scan without a pose has the
///   identity if other scans of the file have a pose (this is the rule of the standard), else std::nullopt.
/// - Time: acquisitionStart in GPS time, seconds since 1980-01-06 00:00:00 UTC without leap seconds. It is not
///   converted. Unix time = GPS time + 315964800 - 18 (the number of leap seconds since 2017). Zero counts as unknown.
/// - Points: cartesian, or else spherical coordinates. Points with an invalid state are NaN.
/// - Values: "intensity" as stored; "rgb" as r << 16 | g << 8 | b with 8 bits each; "time" [s] since acquisitionStart;
///   "row", "column"; other fields, also those of extensions, by their name without the prefix of the namespace.
///   Values that the file marks as invalid are NaN.
/// - Strings, images and unknown elements are ignored.
///
/// A reader keeps the compressed coordinates of its scan in memory and decodes them in read().
std::unique_ptr<ScanFile> openE57(const std::filesystem::path& path);

}  // namespace gaussmap::detail
