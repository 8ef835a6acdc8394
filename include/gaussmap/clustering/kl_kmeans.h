// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/gaussian/gaussian.h"

namespace gaussmap {

struct KLKMeansOptions {
  int k = 8;                ///< clusters asked for, >= 1
  int max_iterations = 50;  ///< of one run of k-means, >= 1
  double tolerance = 1e-6;  ///< a run stops when the distortion falls by less than this fraction
  int max_swaps = 20;       ///< most rounds of the swap loop of Algorithm 2, >= 0 (0 = plain k-means)
  std::uint64_t seed = 0;   ///< same input + same seed = same result
};

/// A partition of n Gaussians.
template <int D>
struct KLClustering {
  std::vector<Gaussian<D>> references;  ///< k' <= k, none empty; the moment match of its members each
  std::vector<int> labels;              ///< n, labels[i] in [0, k')
  double distortion = 0.0;              ///< sum_j alpha_j KL(z_j || w_label(j)) [nat], Yguel 2009 eq. (7)
  int iterations = 0;                   ///< of k-means, all runs together
  bool converged = false;               ///< false: some run stopped at max_iterations
};

}  // namespace gaussmap
