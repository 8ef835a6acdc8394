// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "common/key_index.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap {

/// A Gaussian of the map, as the scan meets it.
struct MapGaussian {
  Vector<3> mean;        ///< [m], about the origin of the registration
  Matrix<3> directions;  ///< unit axes, one a column
  Vector<3> variances;   ///< along them [m^2], without any blur
  Vector<3> tells;       ///< 1: a thin axis; 0: it fills its cell, a shift along it says nothing
};

/// The Gaussians of one scale around a place: of the cell there and of the 26 beside it. Found once a cell.
class MapNeighbours {
 public:
  MapNeighbours(const GaussianMap<3>& map, int scale, const Vector<3>& origin)
      : map_(map), scale_(scale), origin_(origin), place_(map.gaussianCount(scale), kNone) {}

  /// The list of a cell, made if need be. Not thread-safe. `point` [m] about the origin; kNone beyond all cells.
  std::uint32_t listAt(const Vector<3>& point);
  const std::vector<std::uint32_t>& list(std::uint32_t i) const { return lists_[i]; }
  const MapGaussian& operator[](std::uint32_t i) const { return gaussians_[i]; }

  static constexpr std::uint32_t kNone = KeyIndex::kNone;

 private:
  std::uint32_t gaussian(std::size_t index);

  const GaussianMap<3>& map_;
  const int scale_;
  const Vector<3> origin_;
  std::vector<std::uint32_t> place_;  // of the map's Gaussians in gaussians_
  std::vector<MapGaussian> gaussians_;
  std::vector<CellKey<3>> keys_;
  std::vector<std::vector<std::uint32_t>> lists_;  // of keys_
  KeyIndex index_;
};

}  // namespace gaussmap
