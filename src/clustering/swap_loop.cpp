// SPDX-License-Identifier: BSD-3-Clause
#include "swap_loop.h"

#include <limits>

namespace gaussmap::detail {
namespace {

// Relative gain that a swap needs, so that it is not only a rounding error of the distortion.
constexpr double kMinGain = 1e-9;

/// The Gaussian of largest distortion: lines 8 to 13 of Algorithm 2.
struct Worst {
  std::size_t index;
  std::size_t cluster;  // c_max
  double distance;      // d_max
};

template <int D>
Worst worstGaussian(const KLProblem<D>& problem, const KLPartition<D>& partition) {
  const Eigen::VectorXd distances = problem.ownDistances(partition);
  Eigen::Index index = 0;  // the first one if several are equal
  distances.maxCoeff(&index);
  const auto j = static_cast<std::size_t>(index);
  return {j, static_cast<std::size_t>(partition.labels[j]), distances(index)};
}

template <int D>
Gaussian<D> seedAt(const KLProblem<D>& problem, const KLPartition<D>& partition, const Worst& worst, ClusterSeed rule) {
  Gaussian<D> seed = problem.input(worst.index);
  if (rule == ClusterSeed::ParentCovariance) seed.cov = partition.centres[worst.cluster].cov;
  return seed;
}

/// The two closest cluster centres: lines 14, 15.
struct ClosestPair {
  std::size_t first, second;
  double distance;  // d_min
};

template <int D>
ClosestPair closestPair(const KLProblem<D>& problem, const std::vector<Gaussian<D>>& centres) {
  const Eigen::MatrixXd distances = problem.distancesBetween(centres);
  ClosestPair pair{0, 1, std::numeric_limits<double>::infinity()};
  for (Eigen::Index u = 0; u < distances.rows(); ++u)
    for (Eigen::Index v = 0; v < distances.cols(); ++v)
      if (u != v && distances(u, v) < pair.distance)
        pair = {static_cast<std::size_t>(u), static_cast<std::size_t>(v), distances(u, v)};
  return pair;
}

/// Returns the cluster centre that a swap moves: lines 16 to 22. The test is d_max < d_min, as printed in the paper.
/// The text of the paper ("because of its short distance to a different cluster with more elements") suggests d_min <
/// d_max, but that is worse. Measured on cells of real scans, k = 2 ... 12 by insertion: the distortion at k = 12
/// divided by that at k = 1, for the printed test / the suggested test (without any swaps):
///   outdoor lidar, 0.1 m in 1 m     0.538 / 0.544 (0.554)      in 10 m  0.651 / 0.657 (0.655)
///   RGB-D office, 0.02 m in 0.2 m   0.426 / 0.431 (0.456)      in 2 m   0.641 / 0.657 (0.665)
///   indoor laser, 0.1 m in 1 m      0.446 / 0.453 (0.481)      in 10 m  0.599 / 0.594 (0.600)
/// Accepted swaps per run are 0.66 and 0.63, in the same time. The closest pair is seldom the right one to reduce, but
/// it is tried again and again. Most of the benefit of the swaps comes from the random draw.
template <int D>
std::size_t leastNeeded(const KLProblem<D>& problem, const KLPartition<D>& partition, const Worst& worst,
                        Random& random) {
  const ClosestPair pair = closestPair(problem, partition.centres);
  if (worst.distance < pair.distance)
    return partition.counts[pair.second] < partition.counts[pair.first] ? pair.second : pair.first;
  const std::size_t drawn = random.below(partition.centres.size() - 1);
  return drawn < worst.cluster ? drawn : drawn + 1;
}

}  // namespace

template <int D>
KLPartition<D> insertSeed(const KLProblem<D>& problem, const KLPartition<D>& partition,
                          const KLKMeansOptions& options) {
  std::vector<Gaussian<D>> centres = partition.centres;
  centres.push_back(seedAt(problem, partition, worstGaussian(problem, partition), options.seed_rule));
  KLPartition<D> inserted = problem.run(std::move(centres), options, partition.assignment);
  if (problem.momentMatchIsBest()) return inserted;
  KLClusters<D> before = problem.clustersOf(partition.labels, partition.centres.size());
  if (before.distortion < inserted.distortion) static_cast<KLClusters<D>&>(inserted) = std::move(before);
  return inserted;
}

template <int D>
int swapLoop(const KLProblem<D>& problem, const KLKMeansOptions& options, Random& random, KLPartition<D>& partition) {
  int swaps = 0;
  for (; swaps < options.max_swaps && partition.centres.size() > 1; ++swaps) {
    const Worst worst = worstGaussian(problem, partition);
    std::vector<Gaussian<D>> centres = partition.centres;
    centres[leastNeeded(problem, partition, worst, random)] = seedAt(problem, partition, worst, options.seed_rule);
    KLPartition<D> swapped = problem.run(std::move(centres), options, partition.assignment);
    swapped.iterations += partition.iterations;
    const bool accepted = swapped.distortion < partition.distortion * (1.0 - kMinGain) &&
                          swapped.centres.size() >= partition.centres.size();
    if (!accepted) {
      partition.iterations = swapped.iterations;
      break;
    }
    partition = std::move(swapped);
  }
  return swaps;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                              \
  template KLPartition<D> insertSeed<D>(const KLProblem<D>&, const KLPartition<D>&, const KLKMeansOptions&); \
  template int swapLoop<D>(const KLProblem<D>&, const KLKMeansOptions&, Random&, KLPartition<D>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
