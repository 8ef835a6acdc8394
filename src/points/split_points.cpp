// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/points/split_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "points/nearest_mean.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kShapeOfDistance = 0.005;  // weight of the standard deviation in the error by thickness
constexpr std::size_t kPointsPerTask = 4096;

struct Item {
  Eigen::Vector3d point;
  std::uint32_t index;
};

/// The items first ... last - 1, and the values that decide how they are split.
struct PartNode {
  std::uint32_t first = 0, last = 0;
  Eigen::Vector3d mean, axis;
  double error = 0.0;
  std::uint32_t children = 0;  // index of the first of two children, 0 = no children
};

void checkOptions(const SplitPointsOptions& options) {
  require(options.max_parts >= 1, "max_parts", static_cast<double>(options.max_parts), "must be at least 1");
  require(options.max_error >= 0.0 && std::isfinite(options.max_error), "max_error", options.max_error,
          "must be finite and not negative");
  require(options.rounds >= 0, "rounds", options.rounds, "must not be negative");
}

class PointSplitter {
 public:
  PointSplitter(const std::vector<Vector<3>>& points, const SplitPointsOptions& options) : options_(options) {
    items_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) items_[i] = {points[i], std::uint32_t(i)};
    nodes_.push_back(makeNode(0, std::uint32_t(points.size())));
    queue_.push({nodes_[0].error, 0});
  }

  /// Splits until there are this many parts. Returns false if no more splits are possible.
  bool splitTo(std::size_t parts) {
    while (this->parts() < parts) {
      if (queue_.empty()) return false;
      const std::uint32_t worst = queue_.top().second;
      queue_.pop();
      split(worst);
    }
    return true;
  }
  /// Number of parts.
  std::size_t parts() const { return (nodes_.size() + 1) / 2; }

  /// Returns the label of each point from the time when there were this many parts.
  std::vector<std::uint32_t> labels(std::size_t parts) const {
    std::vector<std::uint32_t> labels(items_.size());
    const std::size_t count = 2 * parts - 1;
    std::uint32_t label = 0;
    for (std::size_t n = 0; n < count; ++n) {
      if (nodes_[n].children != 0 && nodes_[n].children < count) continue;
      for (std::uint32_t i = nodes_[n].first; i < nodes_[n].last; ++i) labels[items_[i].index] = label;
      ++label;
    }
    return labels;
  }

 private:
  PartNode makeNode(std::uint32_t first, std::uint32_t last) const {
    PartNode node;
    node.first = first;
    node.last = last;
    const double count = last - first;
    const Eigen::Vector3d origin = items_[first].point;  // keeps the precision far from zero
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::uint32_t i = first; i < last; ++i) sum += items_[i].point - origin;
    node.mean = origin + sum / count;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::uint32_t i = first; i < last; ++i) {
      const Eigen::Vector3d d = items_[i].point - node.mean;
      spread += d * d.transpose();
    }
    spread /= count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(spread);
    node.axis = solver.eigenvectors().col(2);
    const double distance = std::sqrt(std::max(0.0, spread.trace()));
    const double size = options_.rule == SplitRule::Distance
                            ? distance
                            : std::sqrt(std::max(0.0, solver.eigenvalues()[0])) + kShapeOfDistance * distance;
    node.error = last - first > 1 ? std::sqrt(std::sqrt(count)) * size : 0.0;
    return node;
  }

  void split(std::uint32_t index) {
    const PartNode node = nodes_[index];
    if (!(node.error > 0.0)) return;
    const auto begin = items_.begin();
    const auto middle = std::partition(begin + node.first, begin + node.last,
                                       [&](const Item& item) { return (item.point - node.mean).dot(node.axis) < 0.0; });
    const auto half = std::uint32_t(middle - begin);
    if (half == node.first || half == node.last) return;
    nodes_[index].children = std::uint32_t(nodes_.size());
    for (const auto& [first, last] : {std::pair(node.first, half), std::pair(half, node.last)}) {
      nodes_.push_back(makeNode(first, last));
      queue_.push({nodes_.back().error, std::uint32_t(nodes_.size() - 1)});
    }
  }

  const SplitPointsOptions& options_;
  std::vector<Item> items_;
  std::vector<PartNode> nodes_;
  std::priority_queue<std::pair<double, std::uint32_t>> queue_;  // of equal errors, the newest part comes first
};

using Points = std::vector<Vector<3>>;

/// Returns the moments of the parts that have points. Renumbers `labels` without the empty parts.
std::vector<Gaussian<3>> momentsOf(const Points& points, std::vector<std::uint32_t>& labels, std::size_t parts) {
  std::vector<std::uint32_t> first(parts, 0), number(parts, 0), count(parts, 0);
  for (std::size_t i = labels.size(); i-- > 0;) {
    first[labels[i]] = std::uint32_t(i);
    ++count[labels[i]];
  }
  std::uint32_t filled = 0;
  for (std::size_t part = 0; part < parts; ++part)
    if (count[part] > 0) {
      number[part] = filled;
      first[filled] = first[part];
      count[filled++] = count[part];
    }
  std::vector<Gaussian<3>> gaussians(filled);
  std::vector<Eigen::Vector3d> sums(filled, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    labels[i] = number[labels[i]];
    sums[labels[i]] += points[i] - points[first[labels[i]]];
  }
  for (std::size_t part = 0; part < filled; ++part) {
    gaussians[part].weight = count[part];
    gaussians[part].mean = points[first[part]] + sums[part] / gaussians[part].weight;
    gaussians[part].cov.setZero();
  }
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Gaussian<3>& gaussian = gaussians[labels[i]];
    const Eigen::Vector3d d = points[i] - gaussian.mean;
    gaussian.cov += d * d.transpose() / gaussian.weight;
  }
  return gaussians;
}

std::vector<std::uint32_t> samplesOf(const Points& points, const PointParts& parts) {
  std::vector<std::uint32_t> samples(parts.gaussians.size(), 0);
  std::vector<double> least(samples.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t part = parts.labels[i];
    const double square = (points[i] - parts.gaussians[part].mean).squaredNorm();
    if (square >= least[part]) continue;
    least[part] = square;
    samples[part] = std::uint32_t(i);
  }
  return samples;
}

/// Returns the 95 % quantile of the distances [m].
double errorOf(const Points& points, const PointParts& parts, const SplitPointsOptions& options) {
  std::vector<Eigen::Vector3d> normals;
  if (options.rule == SplitRule::Shape)
    for (const Gaussian<3>& gaussian : parts.gaussians) normals.push_back(principalAxes<3>(gaussian).normal());
  std::vector<double> distances(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t part = parts.labels[i];
    const Eigen::Vector3d from =
        points[i] - (options.part_point == PartPoint::Mean ? parts.gaussians[part].mean : points[parts.samples[part]]);
    distances[i] = normals.empty() ? from.norm() : std::abs(normals[part].dot(from));
  }
  return nthSmallest(distances, std::size_t(0.95 * double(distances.size() - 1)));
}

PointParts partsOf(const Points& points, std::vector<std::uint32_t> labels, std::size_t count,
                   const SplitPointsOptions& options) {
  PointParts parts;
  parts.gaussians = momentsOf(points, labels, count);
  parts.labels = std::move(labels);
  parts.samples = samplesOf(points, parts);
  parts.error = errorOf(points, parts, options);
  return parts;
}

/// Runs some rounds of k-means (Lloyd).
PointParts movedToNearest(const Points& points, const PointParts& start, const SplitPointsOptions& options) {
  PointParts parts = start;
  for (int round = 0; round < options.rounds; ++round) {
    const NearestMean nearest(parts.gaussians);
    std::vector<std::uint32_t> labels(points.size());
    parallelFor(points.size(), options.threads, kPointsPerTask,
                [&](std::size_t i) { labels[i] = nearest.find(points[i]); });
    if (labels == parts.labels) break;
    parts.gaussians = momentsOf(points, labels, parts.gaussians.size());
    parts.labels = std::move(labels);
  }
  parts.samples = samplesOf(points, parts);
  parts.error = errorOf(points, parts, options);
  return parts;
}

/// Returns the smallest number of parts that keeps max_error, or max_parts parts if no number does.
PointParts withinError(PointSplitter& splitter, const Points& points, const SplitPointsOptions& options) {
  const auto make = [&](std::size_t count) { return partsOf(points, splitter.labels(count), count, options); };
  std::size_t too_few = 0, enough = 1;
  PointParts best = make(1);
  while (best.error > options.max_error && enough < options.max_parts) {
    too_few = enough;
    splitter.splitTo(std::min(2 * enough, options.max_parts));
    if (splitter.parts() == enough) return best;  // nothing to split: the points of each part are equal
    enough = splitter.parts();
    best = make(enough);
  }
  if (best.error > options.max_error) return best;
  while (enough - too_few > 1) {
    const std::size_t middle = too_few + (enough - too_few) / 2;
    PointParts parts = make(middle);
    if (parts.error > options.max_error) {
      too_few = middle;
    } else {
      enough = middle;
      best = std::move(parts);
    }
  }
  return best;
}

void sortBySample(PointParts& parts) {
  const std::size_t count = parts.samples.size();
  std::vector<std::uint32_t> order(count), number(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return parts.samples[a] < parts.samples[b]; });
  std::vector<Gaussian<3>> gaussians(count);
  for (std::size_t i = 0; i < count; ++i) {
    gaussians[i] = parts.gaussians[order[i]];
    number[order[i]] = std::uint32_t(i);
  }
  parts.gaussians = std::move(gaussians);
  std::sort(parts.samples.begin(), parts.samples.end());
  for (std::uint32_t& label : parts.labels) label = number[label];
}

}  // namespace

PointParts splitPoints(const std::vector<Vector<3>>& points, const SplitPointsOptions& options) {
  checkOptions(options);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite()) throw std::invalid_argument("point " + std::to_string(i) + " is not finite");
  if (points.empty()) return {};
  PointSplitter splitter(points, options);
  PointParts parts;
  if (options.max_error > 0.0) {
    parts = withinError(splitter, points, options);
  } else {
    splitter.splitTo(options.max_parts);
    parts = partsOf(points, splitter.labels(splitter.parts()), splitter.parts(), options);
  }
  if (options.rule == SplitRule::Distance && options.rounds > 0) {
    PointParts moved = movedToNearest(points, parts, options);
    if (moved.error <= std::max(parts.error, options.max_error)) parts = std::move(moved);
  }
  sortBySample(parts);
  return parts;
}

}  // namespace gaussmap
