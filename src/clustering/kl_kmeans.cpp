// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/kl_kmeans.h"

#include <stdexcept>

#include "swap_loop.h"

namespace gaussmap {

template <int D>
KLKMeans<D>::KLKMeans(const KLKMeansOptions& options) : options_(options) {
  checkOptions(options);
}

template <int D>
KLClustering<D> KLKMeans<D>::fit(const std::vector<Gaussian<D>>& data) const {
  const KLProblem<D> problem(data);
  const auto k = static_cast<std::size_t>(options_.k);
  if (k >= data.size()) return problem.eachItsOwn();
  KLPartition<D> partition = problem.oneCluster();
  while (partition.references.size() < k) {
    KLPartition<D> more = insertSeed(problem, partition, options_);
    more.iterations += partition.iterations;
    const bool grown = more.references.size() > partition.references.size();
    partition = std::move(more);
    if (!grown) break;
  }
  Random random(options_.seed);
  const int swaps = swapLoop(problem, options_, random, partition);
  KLClustering<D> clustering = problem.finish(partition);
  clustering.swaps = swaps;
  return clustering;
}

template <int D>
KLClustering<D> KLKMeans<D>::run(const std::vector<Gaussian<D>>& data,
                                 const std::vector<Gaussian<D>>& initial_references) const {
  const KLProblem<D> problem(data);
  if (data.empty()) return {};
  if (initial_references.empty()) throw std::invalid_argument("k-means needs at least one initial reference");
  std::vector<Gaussian<D>> references = initial_references;
  for (Gaussian<D>& w : references) w.mean -= problem.centre();
  return problem.finish(problem.run(std::move(references), options_));
}

template class KLKMeans<2>;
template class KLKMeans<3>;

}  // namespace gaussmap
