// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns true for names of texts that can be scans, but also something else: .txt, .csv and .asc.
bool isTextName(const std::filesystem::path& name);

/// Returns the extension of a file of scans in lower case: ".pcd" (also for .pcd.gz), ".ply", ".las" and so on. Returns
/// "" if listScans() does not treat a file with this name in a directory as scans. Tables such as .csv and .txt are not
/// listed, because they often hold something else.
GAUSSMAP_API std::string scanExtension(const std::filesystem::path& name);

/// Returns the name of a scan without folders, without .gz and without the extension of a file of scans.
GAUSSMAP_API std::string scanStem(const std::filesystem::path& scan);

/// Returns the path below its folder under which a copy of each scan can be written, always with the extension
/// .pcd: cloud.pcd for cloud.pcd.gz and cloud.las. If several scans have the same file name, as in 000000/cloud.pcd and
/// 000001/cloud.pcd, the path of all scans starts with the name of the folder.
GAUSSMAP_API std::vector<std::filesystem::path> scanCopies(const std::vector<std::filesystem::path>& scans);

/// Returns the name by which each scan can be told from the others: its file name, or 000000/cloud.pcd if several scans
/// have the same file name.
GAUSSMAP_API std::vector<std::string> scanNames(const std::vector<std::filesystem::path>& scans);

/// Returns the last folder of a path and the file name, as in 000000/cloud.pcd.
std::string folderAndFileName(const std::filesystem::path& path);

}  // namespace gaussmap::detail
