// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <type_traits>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/gaussian_map.h"
#include "map/in_space.h"

// Commands work on maps in space (3-D) and on planar maps (2-D). The file decides which.
namespace gaussmap::app {

/// The number of dimensions as a type, for generic lambdas: `run<dimensions()>(options)`.
template <int D>
using Dimensions = std::integral_constant<int, D>;

/// Returns 2 if a file holds a planar map. Returns 3 for all other files, also for those that cannot be read: loadMap()
/// reports what is wrong with them, after the options were checked.
int dimensionsOf(const std::filesystem::path& map);

/// Calls run(Dimensions<2>()) for a planar map, else run(Dimensions<3>()).
template <typename Run>
auto forDimensions(int dimensions, const Run& run) {
  return dimensions == 2 ? run(Dimensions<2>()) : run(Dimensions<3>());
}
template <typename Run>
auto forMap(const std::filesystem::path& map, const Run& run) {
  return forDimensions(dimensionsOf(map), run);
}

/// Loads a map: .gmap, or for D = 3 also a PCD file of Gaussians. Throws FileError if it cannot be read or has another
/// number of dimensions; the message then says that the two kinds of maps cannot be combined.
template <int D>
GaussianMap<D> loadMap(const std::filesystem::path& path, MapMetadata* metadata = nullptr);
template <>
GaussianMap<2> loadMap<2>(const std::filesystem::path& path, MapMetadata* metadata);
template <>
GaussianMap<3> loadMap<3>(const std::filesystem::path& path, MapMetadata* metadata);

/// Loads a map of any kind as a map in space. Throws FileError if it cannot be read.
GaussianMap<3> loadInSpace(const std::filesystem::path& path);

/// Returns a map of any kind as a map in space: a planar map lies in the plane z = 0.
inline const GaussianMap<3>& spaceMap(const GaussianMap<3>& map) {
  return map;
}
inline GaussianMap<3> spaceMap(const GaussianMap<2>& map) {
  return detail::inSpace(map);
}

}  // namespace gaussmap::app
