// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "clustering/small_cholesky.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Returns the contribution of a finer Gaussian z to the error of its coarse cell, whose clusters are `centres`: the
/// term min_i (mu_wi - mu_z)' Sigma_z^-1 (mu_wi - mu_z) of Yguel 2009, eq. (6). All means are in one frame. Throws
/// std::domain_error if the covariance of z is not positive definite.
template <int D>
double contributionOf(const Gaussian<D>& z, const std::vector<Gaussian<D>>& centres) {
  const SmallCholesky<D> factor(z.cov);
  if (!factor.positive) throw std::domain_error("error of a cell: a finer covariance is not positive definite");
  double nearest = std::numeric_limits<double>::infinity();
  for (const Gaussian<D>& w : centres)
    nearest = std::min(nearest, (factor.whitening * (w.mean - z.mean)).squaredNorm());
  return nearest;
}

}  // namespace gaussmap::detail
