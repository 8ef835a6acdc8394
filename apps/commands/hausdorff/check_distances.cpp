// SPDX-License-Identifier: BSD-3-Clause
#include "commands/hausdorff/check_distances.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/parallel.h"

namespace gaussmap::app {
namespace {

// Both searches compute sqrt(x^2 + y^2 + z^2) from differences of doubles. FLANN also sums the squares of the bounds
// that skip a branch, so it can return a point that is farther by some rounding errors.
constexpr double kRounding = 1e-12;  // relative

constexpr std::size_t kQueriesPerTask = 1000;
constexpr int kPointsPerLeaf = 15;  // as in PCL

/// Returns a matrix of FLANN over points, which must outlive it.
flann::Matrix<double> matrixOf(const Vector<3>* points, std::size_t count) {
  static_assert(sizeof(Vector<3>) == 3 * sizeof(double));
  return {const_cast<double*>(points->data()), count, 3};  // FLANN only reads
}

}  // namespace

std::vector<double> flannDistances(const std::vector<Vector<3>>& from, const std::vector<Vector<3>>& to, int threads) {
  flann::KDTreeSingleIndex<flann::L2_Simple<double>> tree(matrixOf(to.data(), to.size()),
                                                          flann::KDTreeSingleIndexParams(kPointsPerLeaf));
  tree.buildIndex();
  std::vector<double> distances(from.size());
  detail::parallelFor((from.size() + kQueriesPerTask - 1) / kQueriesPerTask, threads, 1, [&](std::size_t task) {
    const std::size_t first = task * kQueriesPerTask, count = std::min(kQueriesPerTask, from.size() - first);
    std::vector<std::size_t> nearest(count);
    flann::Matrix<std::size_t> indices(nearest.data(), count, 1);
    flann::Matrix<double> squares(distances.data() + first, count, 1);
    tree.knnSearch(matrixOf(from.data() + first, count), indices, squares, 1,
                   flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED, 0.0f));
  });
  for (double& distance : distances) distance = std::sqrt(distance);
  return distances;
}

void requireSame(const std::vector<double>& distances, const std::vector<double>& again, const std::string& from) {
  if (distances.size() != again.size())
    throw std::runtime_error("--check: " + std::to_string(distances.size()) + " distances of the " + from +
                             ", but FLANN computes " + std::to_string(again.size()));
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (std::abs(distances[i] - again[i]) <= kRounding * std::max(distances[i], again[i])) continue;
    char text[128];
    std::snprintf(text, sizeof text, ": %.17g m to the nearest point, but FLANN finds %.17g m", distances[i], again[i]);
    throw std::runtime_error("--check: point " + std::to_string(i) + " of the " + from + text +
                             "; this is an error of gaussmap or FLANN, please report it with the input");
  }
}

std::size_t checkDistances(const std::vector<Vector<3>>& reference, const PointDistances& distances, int threads) {
  requireSame(distances.forward, flannDistances(distances.subject, reference, threads), "subject");
  requireSame(distances.backward, flannDistances(reference, distances.subject, threads), "reference");
  return distances.forward.size() + distances.backward.size();
}

std::size_t checkMaxima(const std::vector<Vector<3>>& subject, const std::vector<Vector<3>>& reference,
                        const HausdorffMaxima& maxima, int threads) {
  const std::vector<double> forward = flannDistances(subject, reference, threads);
  const std::vector<double> backward = flannDistances(reference, subject, threads);
  requireSame({maxima.forward}, {*std::max_element(forward.begin(), forward.end())}, "maximum of the subject");
  requireSame({maxima.backward}, {*std::max_element(backward.begin(), backward.end())}, "maximum of the reference");
  return forward.size() + backward.size();
}

}  // namespace gaussmap::app
