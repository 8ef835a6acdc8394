// SPDX-License-Identifier: BSD-3-Clause
#include "kl_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "small_cholesky.h"

namespace gaussmap::detail {
namespace {

// Rows of the product per block. Their features stay in the first-level cache for any n and k.
constexpr Eigen::Index kBlock = 256;

/// The nearest cluster centres so far, for a block of Gaussians. Labels are doubles because the loops below are
/// vectorised.
struct NearestCentres {
  double distance[kBlock], label[kBlock];

  void clear(Eigen::Index rows) {
    std::fill(distance, distance + rows, std::numeric_limits<double>::infinity());
    std::fill(label, label + rows, 0.0);
  }
};

/// Compares rows of X with column c of Y. X is rows x F and starts at `x`; its columns are `stride` apart. The loops
/// are plain because the matrices of most cells are too small for a general matrix product to be faster.
template <int D>
void compare(const double* x, Eigen::Index stride, Eigen::Index rows, const typename KLProblem<D>::Centres& y,
             Eigen::Index c, NearestCentres& nearest) {
  const Eigen::Matrix<double, KLProblem<D>::kFeatures, 1> weights = y.col(c);
  const auto label = static_cast<double>(c);
  for (Eigen::Index j = 0; j < rows; ++j) {
    double distance = weights(0);  // feature 0 is 1
    for (int f = 1; f < KLProblem<D>::kFeatures; ++f) distance += weights(f) * x[f * stride + j];
    const bool nearer =
        (distance < nearest.distance[j]) | ((distance == nearest.distance[j]) & (label < nearest.label[j]));
    nearest.distance[j] = nearer ? distance : nearest.distance[j];
    nearest.label[j] = nearer ? label : nearest.label[j];
  }
}

/// Writes [1, mu, upper triangle of Sigma + mu mu'] into a row of features.
template <int D, typename Row>
void writeDataFeatures(const Vector<D>& mean, const Matrix<D>& cov, Row&& row) {
  row(0) = 1.0;
  int slot = 1;
  for (int i = 0; i < D; ++i) row(slot++) = mean(i);
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) row(slot++) = cov(i, j) + mean(i) * mean(j);
}

/// Returns y_w of every cluster centre, F x k.
template <int D>
typename KLProblem<D>::Centres centreFeatures(const std::vector<Gaussian<D>>& centres) {
  typename KLProblem<D>::Centres features(KLProblem<D>::kFeatures, static_cast<Eigen::Index>(centres.size()));
  for (std::size_t c = 0; c < centres.size(); ++c) {
    const SmallCholesky<D> factor(centres[c].cov);
    if (!factor.positive || !centres[c].mean.allFinite())
      throw std::domain_error("cluster centre " + std::to_string(c) +
                              ": the mean is not finite or the covariance is not positive definite");
    const Matrix<D> inverse = factor.inverse();
    const Vector<D> information = inverse * centres[c].mean;
    auto column = features.col(static_cast<Eigen::Index>(c));
    column(0) = 0.5 * (centres[c].mean.dot(information) + factor.logDeterminant());
    int slot = 1;
    for (int i = 0; i < D; ++i) column(slot++) = -information(i);
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j) column(slot++) = i == j ? 0.5 * inverse(i, i) : inverse(i, j);
  }
  return features;
}

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
KLProblem<D>::KLProblem(const std::vector<Gaussian<D>>& data) : data_(data) {
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
  const auto n = static_cast<Eigen::Index>(data.size());
  features_.resize(n, kFeatures);
  weights_.resize(n);
  constants_.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Gaussian<D>& z = data[static_cast<std::size_t>(j)];
    const SmallCholesky<D> factor(z.cov);
    if (!factor.positive)
      throw std::domain_error("Gaussian " + std::to_string(j) +
                              ": the covariance is not positive definite; add a noise floor to its eigenvalues");
    const double log_determinant = factor.logDeterminant();
    weighted_log_determinants_ += z.weight * log_determinant;
    weights_(j) = z.weight;
    constants_(j) = -0.5 * (log_determinant + D);
    writeDataFeatures<D>(z.mean - centre_, z.cov, features_.row(j));
  }
}

template <int D>
void KLProblem<D>::assign(const std::vector<Gaussian<D>>& centres, KLAssignment<D>& assignment) const {
  Centres features = centreFeatures<D>(centres);
  const Eigen::Index known = assignment.centres.cols();
  std::vector<char> changed(centres.size(), 1);
  std::size_t changes = centres.size();
  for (Eigen::Index c = 0; c < std::min(known, features.cols()); ++c)
    if (features.col(c) == assignment.centres.col(c)) {
      changed[static_cast<std::size_t>(c)] = 0;
      --changes;
    }
  const bool all = known > features.cols() || 2 * changes > centres.size();
  assignment.centres.swap(features);
  if (all)
    assignAll(assignment);
  else
    assignAgain(assignment, changed);
}

template <int D>
void KLProblem<D>::assignAll(KLAssignment<D>& assignment) const {
  const auto n = static_cast<Eigen::Index>(size());
  assignment.distances.resize(size());
  assignment.labels.resize(size());
  NearestCentres nearest;
  for (Eigen::Index first = 0; first < n; first += kBlock) {
    const Eigen::Index rows = std::min(kBlock, n - first);
    nearest.clear(rows);
    for (Eigen::Index c = 0; c < assignment.centres.cols(); ++c)
      compare<D>(features_.data() + first, n, rows, assignment.centres, c, nearest);
    std::copy(nearest.distance, nearest.distance + rows, assignment.distances.begin() + first);
    std::transform(nearest.label, nearest.label + rows, assignment.labels.begin() + first,
                   [](double label) { return static_cast<int>(label); });
  }
}

template <int D>
void KLProblem<D>::assignAgain(KLAssignment<D>& assignment, const std::vector<char>& changed) const {
  const auto n = static_cast<Eigen::Index>(size()), k = assignment.centres.cols();
  NearestCentres nearest;
  double x[kFeatures * kBlock];  // Gaussians whose cluster centre has moved
  for (Eigen::Index first = 0; first < n; first += kBlock) {
    const Eigen::Index rows = std::min(kBlock, n - first);
    double* const distances = assignment.distances.data() + first;
    int* const labels = assignment.labels.data() + first;
    Eigen::Index moved[kBlock], moves = 0;
    for (Eigen::Index j = 0; j < rows; ++j)
      if (changed[static_cast<std::size_t>(labels[j])]) moved[moves++] = j;
    std::copy(distances, distances + rows, nearest.distance);
    std::copy(labels, labels + rows, nearest.label);
    for (Eigen::Index c = 0; c < k; ++c)
      if (changed[static_cast<std::size_t>(c)])
        compare<D>(features_.data() + first, n, rows, assignment.centres, c, nearest);
    for (Eigen::Index j = 0; j < rows; ++j) {
      distances[j] = nearest.distance[j];
      labels[j] = static_cast<int>(nearest.label[j]);
    }
    for (int f = 1; f < kFeatures; ++f)
      for (Eigen::Index m = 0; m < moves; ++m) x[f * kBlock + m] = features_(first + moved[m], f);
    nearest.clear(moves);
    for (Eigen::Index c = 0; c < k; ++c) compare<D>(x, kBlock, moves, assignment.centres, c, nearest);
    for (Eigen::Index m = 0; m < moves; ++m) {
      distances[moved[m]] = nearest.distance[m];
      labels[moved[m]] = static_cast<int>(nearest.label[m]);
    }
  }
}

template <int D>
Eigen::VectorXd KLProblem<D>::ownDistances(const KLPartition<D>& partition) const {
  const Centres centre_features = centreFeatures<D>(partition.centres);
  Eigen::VectorXd distances(constants_.size());
  for (Eigen::Index j = 0; j < distances.size(); ++j) {
    const int label = partition.labels[static_cast<std::size_t>(j)];
    distances(j) = std::max(0.0, features_.row(j).dot(centre_features.col(label)) + constants_(j));
  }
  return distances;
}

template <int D>
Eigen::MatrixXd KLProblem<D>::distancesBetween(const std::vector<Gaussian<D>>& centres) {
  const auto k = static_cast<Eigen::Index>(centres.size());
  Features features(k, kFeatures);
  for (Eigen::Index c = 0; c < k; ++c) {
    const Gaussian<D>& w = centres[static_cast<std::size_t>(c)];
    writeDataFeatures<D>(w.mean, w.cov, features.row(c));
  }
  Eigen::MatrixXd distances = features * centreFeatures<D>(centres);
  // KL(u || u) = 0 gives the part of each row that depends on u alone.
  const Eigen::VectorXd own = distances.diagonal();
  distances.colwise() -= own;
  return distances;
}

template <int D>
void KLProblem<D>::update(KLPartition<D>& partition) const {
  std::vector<Gaussian<D>>& centres = partition.centres;
  for (Gaussian<D>& w : centres) w = {Vector<D>::Zero(), Matrix<D>::Zero(), 0.0};
  partition.counts.assign(centres.size(), 0);
  for (std::size_t j = 0; j < size(); ++j) {
    const auto label = static_cast<std::size_t>(partition.labels[j]);
    centres[label].weight += data_[j].weight;
    centres[label].mean += data_[j].weight * (data_[j].mean - centre_);
    ++partition.counts[label];
  }
  for (Gaussian<D>& w : centres)
    if (w.weight > 0.0) w.mean /= w.weight;  // eq. (9)
  for (std::size_t j = 0; j < size(); ++j) {
    Gaussian<D>& w = centres[static_cast<std::size_t>(partition.labels[j])];
    const Vector<D> spread = data_[j].mean - centre_ - w.mean;
    w.cov += data_[j].weight * (data_[j].cov + spread * spread.transpose());
  }
  // If the centre is the moment match, the sum of eq. (8) over a cluster needs only determinants:
  // sum alpha_j KL(z_j || w) = (alpha_w ln |Sigma_w| - sum alpha_j ln |Sigma_j|) / 2.
  double weighted_log_determinants = 0.0;
  std::size_t kept = 0;
  std::vector<int> new_label(centres.size());
  for (std::size_t c = 0; c < centres.size(); ++c) {
    new_label[c] = static_cast<int>(kept);
    if (partition.counts[c] == 0) continue;
    centres[c].cov /= centres[c].weight;  // eq. (10), about the mean
    weighted_log_determinants += centres[c].weight * SmallCholesky<D>(centres[c].cov).logDeterminant();
    centres[kept] = centres[c];
    partition.counts[kept++] = partition.counts[c];
  }
  if (kept < centres.size()) {
    centres.resize(kept);
    partition.counts.resize(kept);
    for (int& label : partition.labels) label = new_label[static_cast<std::size_t>(label)];
  }
  partition.distortion = std::max(0.0, 0.5 * (weighted_log_determinants - weighted_log_determinants_));
}

template <int D>
KLPartition<D> KLProblem<D>::run(std::vector<Gaussian<D>> centres, const KLKMeansOptions& options,
                                 KLAssignment<D> earlier) const {
  KLPartition<D> partition;
  partition.centres = std::move(centres);
  partition.assignment = std::move(earlier);
  partition.converged = false;
  double distortion_before = std::numeric_limits<double>::infinity();
  while (!partition.converged && partition.iterations < options.max_iterations) {
    assign(partition.centres, partition.assignment);
    partition.converged = partition.assignment.labels == partition.labels;
    if (partition.converged) break;
    partition.labels = partition.assignment.labels;
    update(partition);
    ++partition.iterations;
    partition.converged = distortion_before - partition.distortion < options.tolerance * distortion_before;
    distortion_before = partition.distortion;
  }
  return partition;
}

template <int D>
KLPartition<D> KLProblem<D>::oneCluster() const {
  KLPartition<D> partition;
  partition.centres.resize(1);
  partition.labels.assign(size(), 0);
  update(partition);
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
