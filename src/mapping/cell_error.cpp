// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/cell_error.h"

#include <stdexcept>
#include <string>

#include "mapping/contribution.h"

namespace gaussmap::detail {

template <int D>
double cellError(const std::vector<Gaussian<D>>& centres, const std::vector<Gaussian<D>>& data,
                 const std::vector<double>& factors) {
  if (!factors.empty() && factors.size() != data.size())
    throw std::invalid_argument("cellError: " + std::to_string(factors.size()) + " factors for " +
                                std::to_string(data.size()) + " finer Gaussians");
  if (data.empty()) return 0.0;
  if (centres.empty()) throw std::invalid_argument("cellError: no clusters to represent the finer Gaussians");
  double sum = 0.0;
  for (std::size_t j = 0; j < data.size(); ++j)
    sum += (factors.empty() ? 1.0 : factors[j]) * contributionOf(data[j], centres);
  return sum / static_cast<double>(data.size());  // eq. (6)
}

template double cellError<2>(const std::vector<Gaussian<2>>&, const std::vector<Gaussian<2>>&,
                             const std::vector<double>&);
template double cellError<3>(const std::vector<Gaussian<3>>&, const std::vector<Gaussian<3>>&,
                             const std::vector<double>&);

}  // namespace gaussmap::detail
