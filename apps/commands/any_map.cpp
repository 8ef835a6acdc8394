// SPDX-License-Identifier: BSD-3-Clause
#include "commands/any_map.h"

#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {

int dimensionsOf(const std::filesystem::path& map) {
  try {
    return isGmap(map) ? mapDimensions(map) : 3;
  } catch (const FileError&) {
    return 3;
  }
}

template <>
GaussianMap<2> loadMap<2>(const std::filesystem::path& path, MapMetadata* metadata) {
  if (isMap(path) && dimensionsOf(path) == 3)
    throw FileError(path, "is a 3-D map, which cannot be combined with a planar map");
  GaussianMap<2> map = load<2>(path);
  if (metadata != nullptr) *metadata = loadMetadata(path);
  return map;
}

template <>
GaussianMap<3> loadMap<3>(const std::filesystem::path& path, MapMetadata* metadata) {
  if (dimensionsOf(path) == 2) throw FileError(path, "is a planar map, which cannot be combined with a 3-D map");
  return loadAny(path, metadata);
}

GaussianMap<3> loadInSpace(const std::filesystem::path& path) {
  return dimensionsOf(path) == 2 ? spaceMap(loadMap<2>(path)) : loadMap<3>(path);
}

}  // namespace gaussmap::app
