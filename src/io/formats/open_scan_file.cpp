// SPDX-License-Identifier: BSD-3-Clause
#include "io/formats/open_scan_file.h"

#include "io/pcd/pcd_scan_file.h"

namespace gaussmap::detail {

std::shared_ptr<const ScanFile> openScanFile(const std::filesystem::path& path, const FileOptions&) {
  return openPcd(path);
}

}  // namespace gaussmap::detail
