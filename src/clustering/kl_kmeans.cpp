// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/kl_kmeans.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "small_cholesky.h"
#include "swap_loop.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Draws up to k cluster centres to start from. Their means are drawn among the input Gaussians as in k-means++ (Arthur
/// & Vassilvitskii 2007), by weight times squared distance to the nearest centre so far. Distances use the covariance
/// of the whole input, and every centre gets this covariance. With equal shapes, the first assignment divides space
/// fairly.
///
/// Measured on cells of real scans with k = 12: the distortion is 0.497 (outdoor lidar), 0.417 (RGB-D) or 0.387 (indoor
/// laser) of the distortion at k = 1. If Algorithm 2 inserts one cluster after the other without swaps between, it is
/// 0.543, 0.443 or 0.462. Drawing takes 0.4 of the time of the insertion.
///
/// Returns fewer than k centres if the input has fewer than k different means.
template <int D>
std::vector<Gaussian<D>> drawCentres(const KLProblem<D>& problem, std::size_t k, Random& random) {
  const Gaussian<D> all = problem.oneCluster().centres.front();
  const Matrix<D> whitening = SmallCholesky<D>(all.cov).whitening;
  std::vector<Gaussian<D>> centres;
  std::vector<double> nearest(problem.size(), std::numeric_limits<double>::infinity());  // squared distances
  std::vector<double> cumulated(problem.size());
  while (centres.size() < k) {
    double sum = 0.0;
    for (std::size_t j = 0; j < problem.size(); ++j)
      cumulated[j] = sum += problem.input(j).weight * (centres.empty() ? 1.0 : nearest[j]);
    if (!(sum > 0.0)) break;
    const auto drawn = std::upper_bound(cumulated.begin(), cumulated.end() - 1, random.uniform() * sum);
    Gaussian<D> centre = problem.input(static_cast<std::size_t>(drawn - cumulated.begin()));
    centre.cov = all.cov;
    for (std::size_t j = 0; j < problem.size(); ++j)
      nearest[j] = std::min(nearest[j], (whitening * (problem.input(j).mean - centre.mean)).squaredNorm());
    centres.push_back(centre);
  }
  return centres;
}

}  // namespace

template <int D>
KLKMeans<D>::KLKMeans(const KLKMeansOptions& options) : options_(options) {
  checkOptions(options);
}

template <int D>
KLClustering<D> KLKMeans<D>::fit(const std::vector<Gaussian<D>>& data) const {
  const KLProblem<D> problem(data, options_.distance);
  const auto k = static_cast<std::size_t>(options_.k);
  if (k >= data.size()) return problem.eachItsOwn();
  Random random(options_.seed);
  KLPartition<D> partition = problem.run(drawCentres(problem, k, random), options_);
  const int swaps = swapLoop(problem, options_, random, partition);
  KLClustering<D> clustering = problem.finish(partition);
  clustering.swaps = swaps;
  return clustering;
}

template <int D>
KLClustering<D> KLKMeans<D>::run(const std::vector<Gaussian<D>>& data,
                                 const std::vector<Gaussian<D>>& initial_centres) const {
  const KLProblem<D> problem(data, options_.distance);
  if (data.empty()) return {};
  if (initial_centres.empty()) throw std::invalid_argument("k-means needs at least one initial cluster centre");
  std::vector<Gaussian<D>> centres = initial_centres;
  for (Gaussian<D>& w : centres) w.mean -= problem.centre();
  return problem.finish(problem.run(std::move(centres), options_));
}

template <int D>
KLClustering<D> insertCluster(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& current_centres,
                              const KLKMeansOptions& options) {
  checkOptions(options);
  const KLProblem<D> problem(data, options.distance);
  if (current_centres.size() + 1 >= data.size()) return problem.eachItsOwn();
  if (current_centres.empty()) return problem.finish(problem.oneCluster());
  std::vector<Gaussian<D>> centres = current_centres;
  for (Gaussian<D>& w : centres) w.mean -= problem.centre();
  // The current centres with the Gaussians nearest to them. Line 9 looks here for the Gaussian of largest distortion.
  KLPartition<D> current;
  current.centres = std::move(centres);
  problem.assign(current.centres, current.assignment);
  current.labels = current.assignment.labels;
  Random random(options.seed);
  KLPartition<D> partition = insertSeed(problem, current, options);
  const int swaps = swapLoop(problem, options, random, partition);
  KLClustering<D> clustering = problem.finish(partition);
  clustering.swaps = swaps;
  return clustering;
}

template class KLKMeans<2>;
template class KLKMeans<3>;
template KLClustering<2> insertCluster<2>(const std::vector<Gaussian<2>>&, const std::vector<Gaussian<2>>&,
                                          const KLKMeansOptions&);
template KLClustering<3> insertCluster<3>(const std::vector<Gaussian<3>>&, const std::vector<Gaussian<3>>&,
                                          const KLKMeansOptions&);

}  // namespace gaussmap
