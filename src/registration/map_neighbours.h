// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/key_index.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// A Gaussian of the map, prepared for the residuals.
struct MapGaussian {
  Vector<3> mean;        ///< [m], relative to the origin of the registration
  Matrix<3> directions;  ///< unit axes, one per column
  Vector<3> variances;   ///< along the axes [m^2], without blur
  Vector<3> tells;       ///< weight per axis: 1 = thin; 0 = fills its cell, a shift along it is unobservable
  double count = 1.0;    ///< points
};

/// Finds the Gaussians of one scale around a point: those of the eight cells that meet at the cell corner nearest to
/// it. Looks up and computes everything once, when it is first needed.
class MapNeighbours {
 public:
  MapNeighbours(const GaussianMap<3>& map, int scale, const Vector<3>& origin);

  /// Widens all Gaussians by the standard deviation `blur` [m] for nearest().
  void setBlur(double blur);
  double blur() const { return blur_; }

  /// Returns the number of the list for a point [m, relative to the origin], and makes the list if necessary. Returns
  /// kNone if the point is out of the range of the grid. Not thread-safe. `hint`: the last list of the point, which is
  /// used again if the point has not moved far, or kNone. A point on a border may get the list of either side.
  std::uint32_t listAt(const Vector<3>& point, std::uint32_t hint = kNone) {
    if (hint != kNone && (point - lists_[hint].corner).cwiseAbs().maxCoeff() <= half_side_) return hint;
    return findList(point);
  }
  /// Returns the Gaussian of a list with the smallest Mahalanobis distance, the first one of equals. Returns kNone if
  /// the list is empty.
  std::uint32_t nearest(std::uint32_t list, const Vector<3>& point) const;
  /// Computes the MapGaussian of Gaussian `i` if necessary. Not thread-safe.
  void prepare(std::uint32_t i) {
    if (place_[i] == kNone) workOut(i);
  }
  /// Returns a Gaussian for which prepare() was called.
  const MapGaussian& operator[](std::uint32_t i) const { return worked_out_[place_[i]]; }

  static constexpr std::uint32_t kNone = KeyIndex::kNone;

 private:
  struct Candidate {
    double x, y, z;                 // mean, relative to the origin [m]
    double xx, yy, zz, xy, xz, yz;  // inverse of the widened covariance, with doubled off-diagonal elements
  };
  struct List {
    Vector<3> corner;         // where its cells meet, relative to the origin [m]
    std::size_t first, last;  // in members_
  };
  struct Cell {
    CellKey<3> key;
    std::size_t index;            // in the map
    std::uint32_t first = kNone;  // index of its first candidate, kNone before addCandidates()
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
  std::vector<Cell> cells_;  // known cells: all children of parents_, or at the coarsest scale those that were found
  std::vector<CellKey<3>> parents_, low_;  // low_: per list, the cell with the lowest coordinates
  std::vector<List> lists_;
  std::vector<std::uint32_t> members_;  // candidates, list after list
  std::vector<Candidate> candidates_;
  std::vector<Matrix<3>> cov_;        // of the candidates
  std::vector<double> count_;         // points of the candidates
  std::vector<std::uint32_t> place_;  // index of the candidates in worked_out_
  std::vector<MapGaussian> worked_out_;
};

}  // namespace gaussmap::detail
