// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/gaussian.h"
#include "kl_problem.h"

namespace gaussmap::detail {

/// One more reference, seeded at the datum of largest distortion, then k-means: lines 5 and 6 of Algorithm 2.
/// Distortion never rises; the number of clusters may stay.
template <int D>
KLPartition<D> insertSeed(const KLProblem<D>& problem, const KLPartition<D>& partition, const KLKMeansOptions& options);

/// Lines 7 to 25 of Algorithm 2: takes the reference that is needed least to the datum of largest distortion, again
/// and again while that pays. Improves `partition`, returns the number of accepted swaps.
template <int D>
int swapLoop(const KLProblem<D>& problem, const KLKMeansOptions& options, Random& random, KLPartition<D>& partition);

}  // namespace gaussmap::detail
