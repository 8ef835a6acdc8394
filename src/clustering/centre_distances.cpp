// SPDX-License-Identifier: BSD-3-Clause
#include "centre_distances.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "distance_kernels.h"

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

/// Evaluates the distances of a kernel.
template <int D, typename Kernel>
class KernelDistances final : public CentreDistances<D> {
 public:
  explicit KernelDistances(std::size_t size)
      : features_(static_cast<Eigen::Index>(size), kFeatures), constants_(static_cast<Eigen::Index>(size)) {}

  void set(std::size_t j, const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& factor) override {
    const auto row = static_cast<Eigen::Index>(j);
    Kernel::writeInput(mean, cov, factor, features_.row(row));
    constants_(row) = Kernel::constant(mean, factor);
  }

  void assign(const std::vector<Gaussian<D>>& centres, CentreAssignment& assignment) const override {
    const Centres features = featuresOf(centres);
    const Eigen::Index known = assignment.centres.cols();
    std::vector<char> changed(centres.size(), 1);
    std::size_t changes = centres.size();
    for (Eigen::Index c = 0; c < std::min(known, features.cols()); ++c)
      if (features.col(c) == assignment.centres.col(c)) {
        changed[static_cast<std::size_t>(c)] = 0;
        --changes;
      }
    const bool all = known > features.cols() || 2 * changes > centres.size();
    assignment.centres = features;
    if (all)
      assignAll(assignment);
    else
      assignAgain(assignment, changed);
  }

  Eigen::VectorXd toOwn(const std::vector<Gaussian<D>>& centres, const std::vector<int>& labels) const override {
    const Centres centre_features = featuresOf(centres);
    Eigen::VectorXd distances(constants_.size());
    for (Eigen::Index j = 0; j < distances.size(); ++j)
      distances(j) =
          std::max(0.0, distance(features_, j, centre_features, labels[static_cast<std::size_t>(j)]) + constants_(j));
    return distances;
  }

  Eigen::MatrixXd between(const std::vector<Gaussian<D>>& centres) const override {
    const auto k = static_cast<Eigen::Index>(centres.size());
    Features features(k, kFeatures);
    for (Eigen::Index c = 0; c < k; ++c) {
      const Gaussian<D>& w = centres[static_cast<std::size_t>(c)];
      Kernel::writeInput(w.mean, w.cov, SmallCholesky<D>(w.cov), features.row(c));
    }
    const Centres centre_features = featuresOf(centres);
    Eigen::MatrixXd distances(k, k);
    if constexpr (Kernel::kIsLinear) {
      distances = features * centre_features;
      // The distance of u to itself is 0. This gives the part of each row that depends on u alone.
      const Eigen::VectorXd own = distances.diagonal();
      distances.colwise() -= own;
    } else {
      for (Eigen::Index u = 0; u < k; ++u)
        for (Eigen::Index v = 0; v < k; ++v) distances(u, v) = distance(features, u, centre_features, v);
    }
    return distances;
  }

 private:
  static constexpr int kFeatures = Kernel::kFeatures;
  using Features = Eigen::Matrix<double, Eigen::Dynamic, kFeatures>;  // n x F, one column per feature
  using Centres = Eigen::Matrix<double, kFeatures, Eigen::Dynamic>;   // F x k

  static Centres featuresOf(const std::vector<Gaussian<D>>& centres) {
    Centres features(kFeatures, static_cast<Eigen::Index>(centres.size()));
    for (std::size_t c = 0; c < centres.size(); ++c) {
      const SmallCholesky<D> factor(centres[c].cov);
      if (!factor.positive || !centres[c].mean.allFinite())
        throw std::domain_error("cluster centre " + std::to_string(c) +
                                ": the mean is not finite or the covariance is not positive definite");
      Kernel::writeCentre(centres[c], factor, features.col(static_cast<Eigen::Index>(c)));
    }
    return features;
  }

  /// Returns the distance of row j to column c, without the constant of the row.
  static double distance(const Features& features, Eigen::Index j, const Centres& centres, Eigen::Index c) {
    if constexpr (Kernel::kIsLinear)
      return features.row(j).dot(centres.col(c));
    else
      return Kernel::at(features.data() + j, features.rows(), centres.col(c), std::numeric_limits<double>::infinity());
  }

  /// Compares rows of X with a column of Y. X is rows x F and starts at `x`; its columns are `stride` apart. The loops
  /// are plain because the matrices of most cells are too small for a general matrix product to be faster.
  static void compare(const double* x, Eigen::Index stride, Eigen::Index rows, const Eigen::MatrixXd& centres,
                      Eigen::Index c, NearestCentres& nearest) {
    const Eigen::Matrix<double, kFeatures, 1> y = centres.col(c);
    const auto label = static_cast<double>(c);
    for (Eigen::Index j = 0; j < rows; ++j) {
      const double distance = Kernel::at(x + j, stride, y, nearest.distance[j]);
      const bool nearer =
          (distance < nearest.distance[j]) | ((distance == nearest.distance[j]) & (label < nearest.label[j]));
      nearest.distance[j] = nearer ? distance : nearest.distance[j];
      nearest.label[j] = nearer ? label : nearest.label[j];
    }
  }

  void assignAll(CentreAssignment& assignment) const {
    const Eigen::Index n = features_.rows();
    assignment.distances.resize(static_cast<std::size_t>(n));
    assignment.labels.resize(static_cast<std::size_t>(n));
    NearestCentres nearest;
    for (Eigen::Index first = 0; first < n; first += kBlock) {
      const Eigen::Index rows = std::min(kBlock, n - first);
      nearest.clear(rows);
      for (Eigen::Index c = 0; c < assignment.centres.cols(); ++c)
        compare(features_.data() + first, n, rows, assignment.centres, c, nearest);
      std::copy(nearest.distance, nearest.distance + rows, assignment.distances.begin() + first);
      std::transform(nearest.label, nearest.label + rows, assignment.labels.begin() + first,
                     [](double label) { return static_cast<int>(label); });
    }
  }

  void assignAgain(CentreAssignment& assignment, const std::vector<char>& changed) const {
    const Eigen::Index n = features_.rows(), k = assignment.centres.cols();
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
          compare(features_.data() + first, n, rows, assignment.centres, c, nearest);
      for (Eigen::Index j = 0; j < rows; ++j) {
        distances[j] = nearest.distance[j];
        labels[j] = static_cast<int>(nearest.label[j]);
      }
      for (int f = 0; f < kFeatures; ++f)
        for (Eigen::Index m = 0; m < moves; ++m) x[f * kBlock + m] = features_(first + moved[m], f);
      nearest.clear(moves);
      for (Eigen::Index c = 0; c < k; ++c) compare(x, kBlock, moves, assignment.centres, c, nearest);
      for (Eigen::Index m = 0; m < moves; ++m) {
        distances[moved[m]] = nearest.distance[m];
        labels[moved[m]] = static_cast<int>(nearest.label[m]);
      }
    }
  }

  Features features_;
  Eigen::VectorXd constants_;
};

}  // namespace

template <int D>
std::unique_ptr<CentreDistances<D>> makeCentreDistances(GaussianDistance distance, std::size_t size) {
  switch (distance) {
    case GaussianDistance::KL:
      return std::make_unique<KernelDistances<D, KLKernel<D>>>(size);
    case GaussianDistance::SymmetricKL:
      return std::make_unique<KernelDistances<D, SymmetricKLKernel<D>>>(size);
    case GaussianDistance::Bhattacharyya:
      return std::make_unique<KernelDistances<D, BhattacharyyaKernel<D>>>(size);
    case GaussianDistance::Wasserstein:
      return std::make_unique<KernelDistances<D, WassersteinKernel<D>>>(size);
  }
  throw std::invalid_argument("distance = " + std::to_string(static_cast<int>(distance)) +
                              ": not a value of GaussianDistance");
}

template std::unique_ptr<CentreDistances<2>> makeCentreDistances<2>(GaussianDistance, std::size_t);
template std::unique_ptr<CentreDistances<3>> makeCentreDistances<3>(GaussianDistance, std::size_t);

}  // namespace gaussmap::detail
