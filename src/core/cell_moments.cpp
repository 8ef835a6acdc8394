// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/cell_moments.h"

#include <stdexcept>

namespace gaussmap {

template <int D>
Vector<D> CellMoments<D>::mean(double side) const {
  const double step_over_count = side / static_cast<double>(kStepsPerCell) / static_cast<double>(count);
  Vector<D> mean;
  for (int axis = 0; axis < D; ++axis)
    mean(axis) = static_cast<double>(sum[static_cast<std::size_t>(axis)]) * step_over_count;
  return mean;
}

template <int D>
Matrix<D> CellMoments<D>::covariance(double side) const {
  // A mean product is below 2^30 steps^2. The rounding of doubles is then 2^-23 steps^2, which is 2^-55 side^2.
  const double step = side / static_cast<double>(kStepsPerCell);
  const double n = static_cast<double>(count);
  Matrix<D> covariance;
  std::size_t slot = 0;
  for (int row = 0; row < D; ++row) {
    const double row_mean = static_cast<double>(sum[static_cast<std::size_t>(row)]) / n;
    for (int column = row; column < D; ++column) {
      const double column_mean = static_cast<double>(sum[static_cast<std::size_t>(column)]) / n;
      const double central = static_cast<double>(product[slot++]) / n - row_mean * column_mean;
      covariance(row, column) = covariance(column, row) = central * step * step;
    }
  }
  return covariance;
}

template <int D>
Gaussian<D> CellMoments<D>::gaussian(double side, double noise) const {
  Gaussian<D> gaussian{mean(side), covariance(side), static_cast<double>(count)};
  gaussian.cov.diagonal().array() += noise * noise;
  return gaussian;
}

template <int D>
void CellMoments<D>::throwTooMany() {
  throw std::length_error("more than 2^33 - 1 points in one cell: use finer cells or fewer scans");
}

template struct CellMoments<2>;
template struct CellMoments<3>;

}  // namespace gaussmap
