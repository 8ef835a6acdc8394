// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/gaussian.h"
#include "kl_problem.h"

namespace gaussmap::detail {

/// Adds a cluster centre at the Gaussian of largest distortion, then runs k-means: lines 5 and 6 of Algorithm 2. The
/// distortion never rises above that of the moment matches of the labels of `partition`. The number of clusters can
/// stay the same.
template <int D>
KLPartition<D> insertSeed(const KLProblem<D>& problem, const KLPartition<D>& partition, const KLKMeansOptions& options);

/// Runs lines 7 to 25 of Algorithm 2: moves the cluster centre that is needed least to the Gaussian of largest
/// distortion. Repeats this while it reduces the distortion. Improves `partition` and returns the number of accepted
/// swaps.
template <int D>
int swapLoop(const KLProblem<D>& problem, const KLKMeansOptions& options, Random& random, KLPartition<D>& partition);

}  // namespace gaussmap::detail
