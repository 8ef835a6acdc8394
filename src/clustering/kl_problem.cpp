// SPDX-License-Identifier: BSD-3-Clause
#include "kl_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/number_text.h"
#include "small_cholesky.h"

namespace gaussmap::detail {
namespace {

template <int D>
void checkMeanAndWeight(const Gaussian<D>& gaussian, std::size_t index) {
  if (!(gaussian.weight > 0.0 && std::isfinite(gaussian.weight)))
    throw std::invalid_argument("Gaussian " + std::to_string(index) + ": weight " + numberText(gaussian.weight) +
                                " is not positive and finite");
  if (!gaussian.mean.allFinite())
    throw std::invalid_argument("Gaussian " + std::to_string(index) + ": the mean is not finite");
}

}  // namespace

void checkOptions(const KLKMeansOptions& options) {
  require(options.k >= 1, "k", options.k, "must be at least 1");
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  require(options.tolerance >= 0.0 && options.tolerance < 1.0, "tolerance", options.tolerance,
          "must be at least 0 and below 1");
  require(options.max_swaps >= 0, "max_swaps", options.max_swaps, "must not be negative");
}

template <int D>
KLProblem<D>::KLProblem(const std::vector<Gaussian<D>>& data, GaussianDistance distance)
    : data_(data), distance_(distance), distances_(makeCentreDistances<D>(distance, data.size())) {
  if (data.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("more than 2^31 - 1 Gaussians");
  double weight = 0.0;
  Vector<D> sum = Vector<D>::Zero();
  for (std::size_t j = 0; j < data.size(); ++j) {
    checkMeanAndWeight(data[j], j);
    weight += data[j].weight;
    sum += data[j].weight * (data[j].mean - data.front().mean);
  }
  if (data.empty()) return;
  centre_ = data.front().mean + sum / weight;
  weights_.resize(static_cast<Eigen::Index>(data.size()));
  for (std::size_t j = 0; j < data.size(); ++j) {
    const Gaussian<D>& z = data[j];
    const SmallCholesky<D> factor(z.cov);
    if (!factor.positive)
      throw std::domain_error("Gaussian " + std::to_string(j) +
                              ": the covariance is not positive definite; add a noise floor to its eigenvalues");
    weighted_log_determinants_ += z.weight * factor.logDeterminant();
    weights_(static_cast<Eigen::Index>(j)) = z.weight;
    distances_->set(j, z.mean - centre_, z.cov, factor);
  }
}

template <int D>
KLClusters<D> KLProblem<D>::clustersOf(std::vector<int> labels, std::size_t k) const {
  KLClusters<D> clusters;
  std::vector<Gaussian<D>>& centres = clusters.centres;
  centres.assign(k, {Vector<D>::Zero(), Matrix<D>::Zero(), 0.0});
  clusters.labels = std::move(labels);
  clusters.counts.assign(k, 0);
  for (std::size_t j = 0; j < size(); ++j) {
    const auto label = static_cast<std::size_t>(clusters.labels[j]);
    centres[label].weight += data_[j].weight;
    centres[label].mean += data_[j].weight * (data_[j].mean - centre_);
    ++clusters.counts[label];
  }
  for (Gaussian<D>& w : centres)
    if (w.weight > 0.0) w.mean /= w.weight;  // eq. (9)
  for (std::size_t j = 0; j < size(); ++j) {
    Gaussian<D>& w = centres[static_cast<std::size_t>(clusters.labels[j])];
    const Vector<D> spread = data_[j].mean - centre_ - w.mean;
    w.cov += data_[j].weight * (data_[j].cov + spread * spread.transpose());
  }
  std::size_t kept = 0;
  std::vector<int> new_label(k);
  for (std::size_t c = 0; c < k; ++c) {
    new_label[c] = static_cast<int>(kept);
    if (clusters.counts[c] == 0) continue;
    centres[c].cov /= centres[c].weight;  // eq. (10), about the mean
    centres[kept] = centres[c];
    clusters.counts[kept++] = clusters.counts[c];
  }
  if (kept < k) {
    centres.resize(kept);
    clusters.counts.resize(kept);
    for (int& label : clusters.labels) label = new_label[static_cast<std::size_t>(label)];
  }
  clusters.distortion = distortionOf(clusters);
  return clusters;
}

template <int D>
double KLProblem<D>::distortionOf(const KLClusters<D>& clusters) const {
  if (distance_ != GaussianDistance::KL) return weights_.dot(ownDistances(clusters));
  // If the centre is the moment match, the sum of eq. (8) over a cluster needs only determinants:
  // sum alpha_j KL(z_j || w) = (alpha_w ln |Sigma_w| - sum alpha_j ln |Sigma_j|) / 2.
  double weighted_log_determinants = 0.0;
  for (const Gaussian<D>& w : clusters.centres)
    weighted_log_determinants += w.weight * SmallCholesky<D>(w.cov).logDeterminant();
  return std::max(0.0, 0.5 * (weighted_log_determinants - weighted_log_determinants_));
}

template <int D>
KLPartition<D> KLProblem<D>::run(std::vector<Gaussian<D>> centres, const KLKMeansOptions& options,
                                 CentreAssignment earlier) const {
  KLPartition<D> partition;
  partition.centres = std::move(centres);
  partition.assignment = std::move(earlier);
  partition.distortion = std::numeric_limits<double>::infinity();
  partition.converged = false;
  while (!partition.converged && partition.iterations < options.max_iterations) {
    assign(partition.centres, partition.assignment);
    partition.converged = partition.assignment.labels == partition.labels;
    if (partition.converged) break;
    KLClusters<D> next = clustersOf(partition.assignment.labels, partition.centres.size());
    ++partition.iterations;
    partition.converged = partition.distortion - next.distortion < options.tolerance * partition.distortion;
    const bool is_worse = next.distortion > partition.distortion && !momentMatchIsBest();
    if (!is_worse) static_cast<KLClusters<D>&>(partition) = std::move(next);
  }
  return partition;
}

template <int D>
KLPartition<D> KLProblem<D>::oneCluster() const {
  KLPartition<D> partition;
  static_cast<KLClusters<D>&>(partition) = clustersOf(std::vector<int>(size(), 0), 1);
  return partition;
}

template <int D>
KLClustering<D> KLProblem<D>::eachItsOwn() const {
  KLClustering<D> clustering;
  clustering.centres = data_;
  for (std::size_t j = 0; j < size(); ++j) clustering.labels.push_back(static_cast<int>(j));
  return clustering;
}

template <int D>
KLClustering<D> KLProblem<D>::finish(const KLPartition<D>& partition) const {
  KLClustering<D> clustering;
  clustering.labels = partition.labels;
  clustering.distortion = partition.distortion;
  clustering.iterations = partition.iterations;
  clustering.converged = partition.converged;
  std::vector<std::vector<Gaussian<D>>> members(partition.centres.size());
  for (std::size_t c = 0; c < members.size(); ++c) members[c].reserve(static_cast<std::size_t>(partition.counts[c]));
  for (std::size_t j = 0; j < size(); ++j) members[static_cast<std::size_t>(partition.labels[j])].push_back(data_[j]);
  for (const std::vector<Gaussian<D>>& parts : members) clustering.centres.push_back(merge(parts));
  return clustering;
}

template class KLProblem<2>;
template class KLProblem<3>;

}  // namespace gaussmap::detail
