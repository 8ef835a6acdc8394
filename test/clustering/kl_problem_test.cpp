// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/kl_problem.h"

#include <gtest/gtest.h>

#include "clustering/random_gaussians.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Changes some centres: replaces, repeats another (ties), adds, removes.
template <int D>
void change(std::vector<Gaussian<D>>& centres, const std::vector<Gaussian<D>>& pool, Random& random) {
  const auto any = [&](std::size_t n) { return static_cast<std::size_t>(random.below(n)); };
  for (std::size_t changes = any(4); changes > 0; --changes) {
    const std::size_t place = any(centres.size());
    switch (any(5)) {
      case 0:
        centres[place] = centres[any(centres.size())];
        break;
      case 1:
        centres.push_back(pool[any(pool.size())]);
        break;
      case 2:
        if (centres.size() > 1) centres.erase(centres.begin() + static_cast<std::ptrdiff_t>(place));
        break;
      default:
        centres[place] = pool[any(pool.size())];
    }
  }
}

template <int D>
void expectAssignmentsLikeFreshOnes(std::uint64_t seed, GaussianDistance distance) {
  Random random(seed);
  const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 600);  // more than two blocks
  const KLProblem<D> problem(data, distance);
  std::vector<Gaussian<D>> pool;
  for (std::size_t j = 0; j < data.size(); ++j) pool.push_back(problem.input(j));
  std::vector<Gaussian<D>> centres(pool.begin(), pool.begin() + 20);
  CentreAssignment kept;
  for (int round = 0; round < 200; ++round) {
    CentreAssignment fresh;
    problem.assign(centres, kept);
    problem.assign(centres, fresh);
    ASSERT_EQ(kept.labels, fresh.labels) << "round " << round;
    ASSERT_EQ(kept.distances, fresh.distances) << "round " << round;
    change<D>(centres, pool, random);
  }
}

TEST(KLProblem, AssignsLikeTheFirstTimeWhateverItAssignedBefore) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    expectAssignmentsLikeFreshOnes<2>(seed, GaussianDistance::KL);
    expectAssignmentsLikeFreshOnes<3>(seed, GaussianDistance::KL);
  }
  for (const GaussianDistance distance :
       {GaussianDistance::SymmetricKL, GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein}) {
    expectAssignmentsLikeFreshOnes<2>(6, distance);
    expectAssignmentsLikeFreshOnes<3>(7, distance);
  }
}

TEST(KLProblem, AssignsEveryDatumToItsNearestCentre) {
  Random random(7);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 300);
  const KLProblem<3> problem(data);
  std::vector<Gaussian<3>> centres;
  for (std::size_t j = 0; j < 12; ++j) centres.push_back(problem.input(25 * j));
  CentreAssignment assignment;
  problem.assign(centres, assignment);
  for (std::size_t j = 0; j < data.size(); ++j) {
    const double own = klDivergence(problem.input(j), centres[static_cast<std::size_t>(assignment.labels[j])]);
    for (const Gaussian<3>& centre : centres)
      ASSERT_LE(own, klDivergence(problem.input(j), centre) * (1 + 1e-9) + 1e-9);
  }
}

}  // namespace
}  // namespace gaussmap
