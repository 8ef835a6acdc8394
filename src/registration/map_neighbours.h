// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
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

/// The Gaussians of one scale around a place: of the eight cells that meet at the corner nearest to it. Everything is
/// looked up or worked out once, when it is first met.
class MapNeighbours {
 public:
  MapNeighbours(const GaussianMap<3>& map, int scale, const Vector<3>& origin)
      : map_(map), scale_(scale), origin_(origin), place_(map.gaussianCount(scale), kNone) {}

  /// Widens all Gaussians by `blur` [m] in the search of the nearest.
  void setBlur(double blur);
  double blur() const { return blur_; }

  /// The list of the cells around a point [m, about the origin], made if need be. Not thread-safe. kNone beyond all
  /// cells.
  std::uint32_t listAt(const Vector<3>& point);
  /// The nearest Gaussian in a list by the Mahalanobis distance, ties to the first; kNone in an empty one.
  std::uint32_t nearest(std::uint32_t list, const Vector<3>& point) const;
  /// Works out Gaussian `i`. Not thread-safe.
  void prepare(std::uint32_t i);
  /// A prepared one.
  const MapGaussian& operator[](std::uint32_t i) const { return *found_[i].worked_out; }

  static constexpr std::uint32_t kNone = KeyIndex::kNone;

 private:
  struct Candidate {
    Vector<3> mean;
    Matrix<3> information;  // of the widened covariance
  };
  struct Found {
    std::size_t index;  // in the map
    std::optional<MapGaussian> worked_out;
  };
  struct Cells {  // by key: Gaussians of the cell, or the list of those around its corner of highest coordinates
    std::vector<CellKey<3>> keys;
    std::vector<std::vector<std::uint32_t>> gaussians;
    KeyIndex index;
  };

  const std::vector<std::uint32_t>& gaussiansIn(const CellKey<3>& key);
  std::uint32_t candidate(std::size_t index);
  Matrix<3> widened(std::size_t index) const;

  const GaussianMap<3>& map_;
  const int scale_;
  const Vector<3> origin_;
  double blur_ = 0.0;
  std::vector<std::uint32_t> place_;  // of the map's Gaussians in candidates_ and found_
  std::vector<Candidate> candidates_;
  std::vector<Found> found_;
  Cells cells_, lists_;
};

}  // namespace gaussmap
