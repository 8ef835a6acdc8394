// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/map_export.h"
#include "map/in_space.h"

namespace gaussmap {

std::size_t savePly(const std::filesystem::path& path, const GaussianMap<2>& map, const GaussianPlyOptions& options) {
  return savePly(path, detail::inSpace(map), options);
}

std::size_t saveVtp(const std::filesystem::path& path, const GaussianMap<2>& map, std::optional<int> scale) {
  return saveVtp(path, detail::inSpace(map), scale);
}

std::size_t saveCsv(const std::filesystem::path& path, const GaussianMap<2>& map, std::optional<int> scale) {
  return saveCsv(path, detail::inSpace(map), scale);
}

}  // namespace gaussmap
