// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Options of openCloudText().
struct CloudTextOptions {
  /// Names of the columns, for example "x y z intensity"; "-" skips a column; "x:mm" and "time:ns" give units. Empty:
  /// the header gives the names, or they are found from the number of columns and their values.
  std::string fields;
};

/// Returns true if the first bytes of a file are those of a text with one point per line: xyz, csv, pts, ptx and so on.
///
/// `start` can end anywhere. Returns true for a pose file too, because it also has a row of numbers per line.
bool isCloudText(std::string_view start);

/// Opens a text with one point per line. Blanks, tabs, commas or semicolons separate the columns.
///
/// A PTS file has one scan per number of points, and a PTX file one scan per header, with its pose. All other texts
/// have one scan. The points of a PTX file are organised: columns() is the number of points per column of the scanner.
/// Values without a unit are not converted, except times that count from 1970 in ms, us or ns: they become seconds, and
/// there is a warning. Throws FileError if the file does not start like such a text, or if its columns are not clear.
/// Throws std::invalid_argument if options.fields is not valid.
std::unique_ptr<ScanFile> openCloudText(const std::filesystem::path& path, const CloudTextOptions& options = {});

}  // namespace gaussmap::detail
