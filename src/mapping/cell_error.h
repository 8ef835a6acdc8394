// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// How badly a coarse cell's clusters stand for the finer Gaussians z_j under it, no unit (squared standard
/// deviations), Yguel 2009 eq. (6): 1/N sum_j min_i (mu_wi - mu_zj)' Sigma_zj^-1 (mu_wi - mu_zj). The factor
/// (1 - eps) of the paper is 1: a map built from all its points has nothing left to learn. References and data share
/// one frame. 0 without data. Throws std::invalid_argument if there are data but no references,
/// std::domain_error if a covariance of the data is not positive definite.
template <int D>
double cellError(const std::vector<Gaussian<D>>& references, const std::vector<Gaussian<D>>& data);

}  // namespace gaussmap::detail
