// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/insert_cluster.h"

#include "swap_loop.h"

namespace gaussmap {
using namespace detail;

template <int D>
KLClustering<D> insertCluster(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& current_references,
                              const KLKMeansOptions& options) {
  checkOptions(options);
  const KLProblem<D> problem(data);
  if (current_references.size() + 1 >= data.size()) return problem.eachItsOwn();
  if (current_references.empty()) return problem.finish(problem.oneCluster());
  std::vector<Gaussian<D>> references = current_references;
  for (Gaussian<D>& w : references) w.mean -= problem.centre();
  // The current references with the data that are nearest to them: what line 9 looks for the worst datum in.
  KLPartition<D> current;
  current.references = std::move(references);
  problem.assign(current.references, current.assignment);
  current.labels = current.assignment.labels;
  Random random(options.seed);
  KLPartition<D> partition = insertSeed(problem, current, options);
  const int swaps = swapLoop(problem, options, random, partition);
  KLClustering<D> clustering = problem.finish(partition);
  clustering.swaps = swaps;
  return clustering;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                   \
  template KLClustering<D> insertCluster<D>(const std::vector<Gaussian<(D)>>&, const std::vector<Gaussian<(D)>>&, \
                                            const KLKMeansOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
