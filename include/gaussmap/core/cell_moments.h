// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Number of quantisation steps per side of a cell. A step is side / 65536 (1.5 micrometres for a side of 10 cm).
/// Points are rounded to the lattice of these steps.
inline constexpr std::int64_t kStepsPerCell = std::int64_t{1} << 16;

/// Holds exact sums over the points of one cell, in integers.
///
/// The sums are bit-identical for any order of the points, any number of threads, and any split into parts that are
/// merged later. An offset from the cell's centre lies in [-32768, 32767] steps, so a product of two offsets is at most
/// 2^30. The sum of 2^33 - 1 such products fits 64 bits, so a cell holds up to 2^33 - 1 points. For more points add()
/// and operator+=() throw std::length_error and leave the sums unchanged.
template <int D>
struct GAUSSMAP_API CellMoments {
  static constexpr int kProducts = D * (D + 1) / 2;                        ///< number of products per point
  static constexpr std::int64_t kMaxPoints = (std::int64_t{1} << 33) - 1;  ///< maximum number of points per cell
  using Offset = std::array<std::int32_t, D>;                              ///< point minus the cell's centre [steps]

  std::int64_t count = 0;                         ///< number of points
  std::array<std::int64_t, D> sum{};              ///< sum of offsets [steps]
  std::array<std::int64_t, kProducts> product{};  ///< sum of products [steps^2], in the order xx xy xz yy yz zz

  /// Adds one point. Throws std::length_error if the cell is full.
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

  /// Adds the sums of other points of the same cell. Throws std::length_error if the total exceeds kMaxPoints.
  CellMoments& operator+=(const CellMoments& other) {
    requireRoom(other.count);
    count += other.count;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other.sum[i];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] += other.product[i];
    return *this;
  }

  /// Subtracts the sums of `part`. The points of `part` must be among the points of this cell.
  CellMoments& operator-=(const CellMoments& part) {
    count -= part.count;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] -= part.sum[i];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] -= part.product[i];
    return *this;
  }

  /// Throws std::length_error if the cell cannot hold `more` additional points.
  void requireRoom(std::int64_t more) const {
    if (more > kMaxPoints - count) throwTooMany();
  }

  /// Returns true if all sums are equal.
  friend bool operator==(const CellMoments& a, const CellMoments& b) {
    return a.count == b.count && a.sum == b.sum && a.product == b.product;
  }
  /// Returns true if any sum differs.
  friend bool operator!=(const CellMoments& a, const CellMoments& b) { return !(a == b); }

  /// Returns the sample mean relative to the cell's centre, D x 1 [m]. `side` is the side of the cell [m].
  /// `count` must be positive.
  Vector<D> mean(double side) const;
  /// Returns the sample covariance (divided by n), D x D [m^2]. The covariance can be singular. `side` is the side of
  /// the cell [m]. `count` must be positive.
  Matrix<D> covariance(double side) const;
  /// Returns the Gaussian of the cell, with the mean relative to the cell's centre.
  ///
  /// The covariance is the sample covariance + noise^2 I, which is positive definite for noise > 0 [m]. The weight is
  /// `count`. Every eigenvalue thus grows by noise^2; small eigenvalues are not raised to a minimum instead. The moment
  /// match of several cells therefore has the covariance of all their points + the same noise^2 I.
  Gaussian<D> gaussian(double side, double noise) const;

 private:
  [[noreturn]] static void throwTooMany();
};

}  // namespace gaussmap
