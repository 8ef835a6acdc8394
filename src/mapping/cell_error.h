// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Returns how badly the clusters w_i of a coarse cell (`centres`) represent the finer Gaussians z_j under it
/// (`data`). Yguel 2009 eq. (6): 1/N sum_j f_j min_i (mu_wi - mu_zj)' Sigma_zj^-1 (mu_wi - mu_zj), without unit
/// (squared standard deviations). `factors` = f_j, one per finer Gaussian; the paper has 1 - eps_zj, with the learning
/// rate eps. If it is empty, all are 1, because a map built from all its points has nothing left to learn. All means
/// are in one frame. The error is 0 if `data` is empty. Throws std::invalid_argument if there are finer Gaussians but
/// no clusters, or another number of factors, and std::domain_error if the covariance of a finer Gaussian is not
/// positive definite.
template <int D>
double cellError(const std::vector<Gaussian<D>>& centres, const std::vector<Gaussian<D>>& data,
                 const std::vector<double>& factors = {});

}  // namespace gaussmap::detail
