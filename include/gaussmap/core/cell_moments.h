// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A cell's side in quantisation steps: points snap to a lattice of side / 65536 (1.5 micrometres for 10 cm).
inline constexpr std::int64_t kStepsPerCell = std::int64_t{1} << 16;

/// Exact sums over the points of one cell, in integers, so that any order of points, any number of threads
/// and any split into parts merged later give the same bytes. Offsets are counted from the cell's centre in
/// steps, -32768 ... 32767: a product has at most 30 bits, so a cell holds up to 2^33 - 1 points. One more is refused:
/// add() and += throw std::length_error and leave the sums as they were.
template <int D>
struct GAUSSMAP_API CellMoments {
  static constexpr int kProducts = D * (D + 1) / 2;
  static constexpr std::int64_t kMaxPoints = (std::int64_t{1} << 33) - 1;
  using Offset = std::array<std::int32_t, D>;

  std::int64_t count = 0;
  std::array<std::int64_t, D> sum{};              ///< sum of offsets [steps]
  std::array<std::int64_t, kProducts> product{};  ///< sum of products, upper triangle by rows: xx xy xz yy yz zz

  void add(const Offset& offset) {
    requireRoom(1);
    ++count;
    int slot = 0;
    for (std::size_t row = 0; row < D; ++row) {
      sum[row] += offset[row];
      for (std::size_t column = row; column < D; ++column)
        product[static_cast<std::size_t>(slot++)] += std::int64_t{offset[row]} * offset[column];
    }
  }

  /// Sums of two disjoint sets of points of the same cell.
  CellMoments& operator+=(const CellMoments& other) {
    requireRoom(other.count);
    count += other.count;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other.sum[i];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] += other.product[i];
    return *this;
  }

  /// Takes away a part of the points.
  CellMoments& operator-=(const CellMoments& part) {
    count -= part.count;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] -= part.sum[i];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] -= part.product[i];
    return *this;
  }

  /// Throws std::length_error if so many more points are too many.
  void requireRoom(std::int64_t more) const {
    if (more > kMaxPoints - count) throwTooMany();
  }

  friend bool operator==(const CellMoments& a, const CellMoments& b) {
    return a.count == b.count && a.sum == b.sum && a.product == b.product;
  }
  friend bool operator!=(const CellMoments& a, const CellMoments& b) { return !(a == b); }

  /// Sample mean about the cell's centre, D x 1 [m]; `side` = the cell's side [m]; count > 0.
  Vector<D> mean(double side) const;
  /// Sample covariance (divided by n), D x D [m^2], possibly singular; count > 0.
  Matrix<D> covariance(double side) const;
  /// Mean about the cell's centre, covariance + noise^2 I (positive definite for noise > 0), weight = count.
  /// The floor is added, not clamped: moment matching of cells then equals the moments of all their points
  /// plus the same floor, at every scale.
  Gaussian<D> gaussian(double side, double noise) const;

 private:
  [[noreturn]] static void throwTooMany();
};

}  // namespace gaussmap
