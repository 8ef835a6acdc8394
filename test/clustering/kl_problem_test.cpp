// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/kl_problem.h"

#include <gtest/gtest.h>

#include "clustering/random_gaussians.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Changes some references: replaces, repeats another (ties), adds, removes.
template <int D>
void change(std::vector<Gaussian<D>>& references, const std::vector<Gaussian<D>>& pool, Random& random) {
  const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random.below(n)); };
  for (std::size_t changes = any(4); changes > 0; --changes) {
    const std::size_t place = any(references.size());
    switch (any(5)) {
      case 0:
        references[place] = references[any(references.size())];
        break;
      case 1:
        references.push_back(pool[any(pool.size())]);
        break;
      case 2:
        if (references.size() > 1) references.erase(references.begin() + static_cast<std::ptrdiff_t>(place));
        break;
      default:
        references[place] = pool[any(pool.size())];
    }
  }
}

template <int D>
void expectAssignmentsLikeFreshOnes(std::uint64_t seed) {
  Random random(seed);
  const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 600);  // more than two blocks
  const KLProblem<D> problem(data);
  std::vector<Gaussian<D>> pool;
  for (std::size_t j = 0; j < data.size(); ++j) pool.push_back(problem.datum(j));
  std::vector<Gaussian<D>> references(pool.begin(), pool.begin() + 20);
  KLAssignment<D> kept;
  for (int round = 0; round < 200; ++round) {
    KLAssignment<D> fresh;
    problem.assign(references, kept);
    problem.assign(references, fresh);
    ASSERT_EQ(kept.labels, fresh.labels) << "round " << round;
    ASSERT_EQ(kept.distances, fresh.distances) << "round " << round;
    change<D>(references, pool, random);
  }
}

TEST(KLProblem, AssignsLikeTheFirstTimeWhateverItAssignedBefore) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    expectAssignmentsLikeFreshOnes<2>(seed);
    expectAssignmentsLikeFreshOnes<3>(seed);
  }
}

TEST(KLProblem, AssignsEveryDatumToItsNearestReference) {
  Random random(7);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 300);
  const KLProblem<3> problem(data);
  std::vector<Gaussian<3>> references;
  for (std::size_t j = 0; j < 12; ++j) references.push_back(problem.datum(25 * j));
  KLAssignment<3> assignment;
  problem.assign(references, assignment);
  for (std::size_t j = 0; j < data.size(); ++j) {
    const double own = klDivergence(problem.datum(j), references[static_cast<std::size_t>(assignment.labels[j])]);
    for (const Gaussian<3>& reference : references)
      ASSERT_LE(own, klDivergence(problem.datum(j), reference) * (1 + 1e-9) + 1e-9);
  }
}

}  // namespace
}  // namespace gaussmap
