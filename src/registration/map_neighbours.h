// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/key_index.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

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
  MapNeighbours(const GaussianMap<3>& map, int scale, const Vector<3>& origin);

  /// Widens all Gaussians by `blur` [m] in the search of the nearest.
  void setBlur(double blur);
  double blur() const { return blur_; }

  /// The list of the cells around a point [m, about the origin], made if need be. Not thread-safe. kNone beyond all
  /// cells. `hint`: a list that is right if the point has not moved far, or kNone; within the rounding of the
  /// lattice either list of a border may come.
  std::uint32_t listAt(const Vector<3>& point, std::uint32_t hint = kNone) {
    if (hint != kNone && (point - lists_[hint].corner).cwiseAbs().maxCoeff() <= half_side_) return hint;
    return findList(point);
  }
  /// The nearest Gaussian in a list by the Mahalanobis distance, ties to the first; kNone in an empty one.
  std::uint32_t nearest(std::uint32_t list, const Vector<3>& point) const;
  /// Works out Gaussian `i`. Not thread-safe.
  void prepare(std::uint32_t i) {
    if (place_[i] == kNone) workOut(i);
  }
  /// A prepared one.
  const MapGaussian& operator[](std::uint32_t i) const { return worked_out_[place_[i]]; }

  static constexpr std::uint32_t kNone = KeyIndex::kNone;

 private:
  struct Candidate {
    double x, y, z;                 // the mean, about the origin
    double xx, yy, zz, xy, xz, yz;  // the inverse of the widened covariance; twice what is not on its diagonal
  };
  struct List {
    Vector<3> corner;         // where its cells meet, about the origin
    std::size_t first, last;  // in members_
  };
  struct Cell {
    CellKey<3> key;
    std::size_t index;            // in the map
    std::uint32_t first = kNone;  // of its candidates, once there are some
  };

  std::uint32_t findList(const Vector<3>& point);
  void enterCellsUnder(const CellKey<3>& parent);
  std::uint32_t cellAt(const CellKey<3>& key);
  void addCandidates(Cell& cell);
  void widen(std::size_t i);
  void workOut(std::uint32_t i);

  const GaussianMap<3>& map_;
  const int scale_;
  const Vector<3> origin_;
  const double half_side_;
  double blur_ = 0.0;
  KeyIndex cell_index_, parent_index_, list_index_;
  std::vector<Cell> cells_;  // of the map: all below the parents, or, at the coarsest scale, those that were found
  std::vector<CellKey<3>> parents_, low_;  // entered so far; of the lists' cells, those of lowest coordinates
  std::vector<List> lists_;
  std::vector<std::uint32_t> members_;  // candidates, list after list
  std::vector<Candidate> candidates_;
  std::vector<Matrix<3>> cov_;        // of the candidates
  std::vector<std::uint32_t> place_;  // of the candidates in worked_out_
  std::vector<MapGaussian> worked_out_;
};

}  // namespace gaussmap::detail
