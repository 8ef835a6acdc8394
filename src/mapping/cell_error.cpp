// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/cell_error.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "clustering/small_cholesky.h"

namespace gaussmap::detail {

template <int D>
double cellError(const std::vector<Gaussian<D>>& centres, const std::vector<Gaussian<D>>& data) {
  if (data.empty()) return 0.0;
  if (centres.empty()) throw std::invalid_argument("cellError: no clusters to represent the finer Gaussians");
  double sum = 0.0;
  for (const Gaussian<D>& z : data) {
    const SmallCholesky<D> factor(z.cov);
    if (!factor.positive) throw std::domain_error("cellError: a finer covariance is not positive definite");
    double nearest = std::numeric_limits<double>::infinity();
    for (const Gaussian<D>& w : centres) {
      const Vector<D> difference = w.mean - z.mean;
      nearest = std::min(nearest, (factor.whitening * difference).squaredNorm());
    }
    sum += nearest;
  }
  return sum / static_cast<double>(data.size());  // eq. (6)
}

template double cellError<2>(const std::vector<Gaussian<2>>&, const std::vector<Gaussian<2>>&);
template double cellError<3>(const std::vector<Gaussian<3>>&, const std::vector<Gaussian<3>>&);

}  // namespace gaussmap::detail
