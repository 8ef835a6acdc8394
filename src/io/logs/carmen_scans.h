// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/io/logs/carmen_log.h"
#include "gaussmap/version.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Returns true if a text starts like a log of CARMEN. `start` is the beginning of the text and can end anywhere. The
/// first line that is neither empty nor a comment must be a message, such as "FLASER 180 ...". Or a line before it is
/// the comment "# message formats defined".
GAUSSMAP_API bool isCarmenText(std::string_view start);

/// Returns one text per damaged line of a log, and the number of the others if there are many.
GAUSSMAP_API std::vector<std::string> warningsOf(const CarmenLog& log);

/// Opens a log of CARMEN, plain or gzip, as a file with one scan per sweep of the laser, see readCarmenLog().
///
/// Each beam is a point [m] in the sensor frame with z = 0; a beam without a return is NaN. The poses are those of the
/// laser in the log. If any sweep has no time, or the same time as the sweep before it, no scan has a time: the times
/// are too coarse to order the sweeps. Damaged lines give warnings. Throws FileError like readCarmenLog().
GAUSSMAP_API std::unique_ptr<ScanFile> openCarmenScans(const std::filesystem::path& path);

}  // namespace gaussmap::detail
