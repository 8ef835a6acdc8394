// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "small_cholesky.h"

namespace gaussmap::detail {

/// The nearest cluster centre of every input Gaussian. It is kept from one round to the next: if the centre of a
/// Gaussian has not moved, only a centre that has moved can be nearer.
struct CentreAssignment {
  Eigen::MatrixXd centres;        // the numbers that represent each centre, one column per centre
  std::vector<double> distances;  // to the nearest centre, up to a constant per Gaussian
  std::vector<int> labels;        // the index of the nearest centre
};

/// The distances of one kind between n input Gaussians and cluster centres. All means are relative to the same origin.
/// The functions throw std::domain_error if a centre has no finite mean or no positive definite covariance.
template <int D>
class CentreDistances {
 public:
  virtual ~CentreDistances() = default;

  /// Sets input Gaussian j. `factor` is the factor of its covariance. All n must be set before any other call.
  virtual void set(std::size_t j, const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& factor) = 0;

  /// Finds the nearest of these cluster centres for every input Gaussian. Ties go to the smaller label. `assignment`
  /// can hold any earlier assignment of the same input. This saves time and does not change the result.
  virtual void assign(const std::vector<Gaussian<D>>& centres, CentreAssignment& assignment) const = 0;
  /// Returns the distance of every input Gaussian z_j to the centre of its label.
  virtual Eigen::VectorXd toOwn(const std::vector<Gaussian<D>>& centres, const std::vector<int>& labels) const = 0;
  /// Returns the distances from u to v of all pairs of cluster centres, k x k.
  virtual Eigen::MatrixXd between(const std::vector<Gaussian<D>>& centres) const = 0;
};

/// Returns the distances of `size` input Gaussians, which have not been set yet.
template <int D>
std::unique_ptr<CentreDistances<D>> makeCentreDistances(GaussianDistance distance, std::size_t size);

}  // namespace gaussmap::detail
