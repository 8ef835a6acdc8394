// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/thin_points.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "clustering/ward.h"
#include "core/check.h"
#include "core/quantile.h"
#include "mapping/sorted_cells.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kDefaultBudget = 10000;
// At least so many cells per Gaussian. More cells take longer and do not give nearer Gaussians. With many Gaussians,
// the time of the merges counts.
constexpr double kCellsPerGaussian = 2.0, kCellsPerGaussianIfMany = 1.35;
constexpr std::size_t kPointsPerGaussianIfMany = 10;
constexpr std::size_t kFewestCells = 32;
constexpr double kBeforeLastRound = 1.2;  // clusters per Gaussian
constexpr double kCellPerError = 0.9;     // side of a cell per max_error: about two cells per Gaussian
constexpr double kWithinFewest = 1.02;    // of the smallest number of Gaussians that keeps max_error
constexpr int kShortCode = 12;            // bits per axis that three passes of a radix sort take
constexpr int kShortCodeOfFew = 10;       // four passes of the sort of few points
constexpr std::size_t kFewPoints = 3000;

void checkOptions(const ThinPointsOptions& options) {
  if (options.max_gaussians)
    require(*options.max_gaussians >= 1, "max_gaussians", double(*options.max_gaussians), "must be at least 1");
  require(options.max_error >= 0.0 && std::isfinite(options.max_error), "max_error", options.max_error,
          "must be finite and not negative");
  require(options.leaf_size >= 0.0 && std::isfinite(options.leaf_size), "leaf_size", options.leaf_size,
          "must be finite and not negative");
  require(options.scale >= 0 && options.scale < SortedPoints::kMaxBits, "scale", options.scale, "must be in [0, 19]");
  require(options.scale == 0 || options.leaf_size > 0.0, "scale", options.scale,
          "needs a leaf size, because only cells of a given size have scales");
}

/// Returns the coarsest level with at least `cells` cells, or level 0.
int levelFor(const SortedPoints& sorted, std::size_t cells) {
  int level = 0;
  while (level + 1 < sorted.bits() && sorted.cellCount(level + 1) >= cells) ++level;
  return level;
}

/// Returns the coarsest level with cells of at most this side [m], or level 0.
int levelFor(const SortedPoints& sorted, double side) {
  int level = 0;
  while (level + 1 < sorted.bits() && sorted.side(level + 1) <= side) ++level;
  return level;
}

/// Sums the moments of cells, relative to the centre of the first cell, in sides of a cell.
struct UnionMoments {
  double count = 0.0;
  double sum[3] = {};
  double product[6] = {};  // xx xy xz yy yz zz
  CellKey<3> first{};

  void add(const CellKey<3>& key, const CellMoments<3>& moments) {
    constexpr double kStep = 1.0 / double(kStepsPerCell);
    if (count == 0.0) first = key;
    const auto n = double(moments.count);
    double shift[3], offset[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shift[axis] = static_cast<double>(static_cast<std::int64_t>(key[axis]) - first[axis]);
      offset[axis] = double(moments.sum[axis]) * kStep;
      sum[axis] += offset[axis] + n * shift[axis];
    }
    std::size_t slot = 0;
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = row; column < 3; ++column, ++slot)
        product[slot] += double(moments.product[slot]) * (kStep * kStep) + shift[row] * offset[column] +
                         shift[column] * offset[row] + n * shift[row] * shift[column];
    count += n;
  }

  Gaussian<3> gaussian(double side) const {
    Gaussian<3> gaussian;
    gaussian.weight = count;
    std::size_t slot = 0;
    for (std::size_t row = 0; row < 3; ++row) {
      gaussian.mean[Eigen::Index(row)] = (double(first[row]) + 0.5 + sum[row] / count) * side;
      for (std::size_t column = row; column < 3; ++column, ++slot) {
        const double central = product[slot] / count - sum[row] / count * (sum[column] / count);
        gaussian.cov(Eigen::Index(row), Eigen::Index(column)) = gaussian.cov(Eigen::Index(column), Eigen::Index(row)) =
            central * side * side;
      }
      if (gaussian.cov(Eigen::Index(row), Eigen::Index(row)) < 0.0)
        gaussian.cov(Eigen::Index(row), Eigen::Index(row)) = 0.0;  // rounding
    }
    return gaussian;
  }
};

/// Returns the same as percentile(values, 95) for values that are not negative. A histogram of the leading bits leaves
/// few values to be sorted.
float percentile95(std::vector<float>& values) {
  constexpr std::size_t kFewValues = 5000;
  constexpr int kShift = 20;  // leaves the exponent and three bits of the mantissa
  if (values.size() < kFewValues) return percentile(values, 95);
  const auto bucketOf = [](float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits >> kShift;
  };
  std::vector<std::uint32_t> counts(std::size_t{1} << (32 - kShift), 0);
  for (const float value : values) ++counts[bucketOf(value)];
  std::size_t rank = (values.size() * 95 + 99) / 100 - 1;
  std::uint32_t bucket = 0;
  for (; rank >= counts[bucket]; ++bucket) rank -= counts[bucket];
  std::vector<float> few;
  few.reserve(counts[bucket]);
  for (const float value : values)
    if (bucketOf(value) == bucket) few.push_back(value);
  return nthSmallest(few, rank);
}

/// The cells of a cloud and the clusters that can be made from them.
class CloudCells {
 public:
  CloudCells(const SortedPoints& sorted, const PointsView& points, int level)
      : sorted_(sorted), points_(points), cells_(cellsOf(sorted, points, level)), bits_(sorted.bits() - level) {
    clusters_.resize(cells_.keys.size());
    for (std::size_t i = 0; i < clusters_.size(); ++i) {
      const CellMoments<3>& moments = cells_.moments[i];
      const double per_side = 1.0 / double(kStepsPerCell) / double(moments.count);
      const auto place = [&](std::size_t axis) {
        return double(cells_.keys[i][axis]) + double(moments.sum[axis]) * per_side;
      };
      clusters_[i] = {place(0), place(1), place(2), double(moments.count), cells_.codes[i]};
    }
  }

  std::size_t size() const { return clusters_.size(); }

  /// Returns the labels of the cells after merging them to at most `count` clusters.
  std::vector<std::uint32_t> labels(std::size_t count) {
    std::vector<std::uint32_t> labels(size());
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = std::uint32_t(i);
    if (size() <= count) return labels;
    const bool are_few = size() <= 4 * WardMerges::kMaxGroup;  // then one round saves time
    const auto more = are_few ? count : std::max(count, std::size_t(kBeforeLastRound * double(count)));
    std::vector<WardCluster> clusters;
    std::size_t left = size();
    if (left > more) {
      if (!first_merges_) first_merges_.emplace(clusters_, bits_);
      labels = first_merges_->cut(more);
      clusters = unite(clusters_, labels);
    } else {
      clusters = clusters_;
    }
    while (clusters.size() > count) {
      const std::vector<std::uint32_t> unions = WardMerges(clusters, bits_).cut(count);
      for (std::uint32_t& label : labels) label = unions[label];
      clusters = unite(clusters, unions);
    }
    return labels;
  }

  ThinnedPoints thinned(std::vector<std::uint32_t> labels, PartPoint part_point) && {
    ThinnedPoints thinned = gaussians(std::move(labels));
    thinned.error = measure(thinned, part_point, &thinned.samples, &thinned.labels);
    thinned.cell_side = cells_.side;
    thinned.keys = std::move(cells_.keys);
    thinned.moments = std::move(cells_.moments);
    return thinned;
  }

  double error(std::vector<std::uint32_t> labels, PartPoint part_point) const {
    const ThinnedPoints thinned = gaussians(std::move(labels));
    std::vector<std::uint32_t> samples;
    return measure(thinned, part_point, part_point == PartPoint::Sample ? &samples : nullptr, nullptr);
  }

 private:
  /// Returns the unions, in the order of their first clusters.
  static std::vector<WardCluster> unite(const std::vector<WardCluster>& clusters,
                                        const std::vector<std::uint32_t>& unions) {
    std::vector<WardCluster> united;
    united.reserve(clusters.size());
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      const WardCluster& part = clusters[i];
      if (unions[i] == united.size()) {
        united.push_back(part);
        continue;
      }
      WardCluster& whole = united[unions[i]];
      whole.weight += part.weight;
      const double share = part.weight / whole.weight;
      whole.x += share * (part.x - whole.x);
      whole.y += share * (part.y - whole.y);
      whole.z += share * (part.z - whole.z);
    }
    return united;
  }

  /// Returns a result with only Gaussians and labels of cells.
  ThinnedPoints gaussians(std::vector<std::uint32_t> labels) const {
    ThinnedPoints thinned;
    const std::size_t count = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + std::size_t{1};
    std::vector<UnionMoments> moments(count);
    for (std::size_t i = 0; i < labels.size(); ++i) moments[labels[i]].add(cells_.keys[i], cells_.moments[i]);
    thinned.gaussians.reserve(count);
    for (const UnionMoments& one : moments) thinned.gaussians.push_back(one.gaussian(cells_.side));
    thinned.cell_labels = std::move(labels);
    return thinned;
  }

  /// Returns the 95 % quantile of the distances [m]. Fills `samples` and `labels` unless they are null.
  double measure(const ThinnedPoints& thinned, PartPoint part_point, std::vector<std::uint32_t>* samples,
                 std::vector<std::int32_t>* labels) const {
    if (labels != nullptr) labels->assign(points_.count, -1);
    if (sorted_.size() == 0) return 0.0;
    std::vector<float> squares(sorted_.size());
    std::vector<float> least(samples != nullptr ? thinned.gaussians.size() : 0, std::numeric_limits<float>::infinity());
    if (samples != nullptr) samples->assign(thinned.gaussians.size(), 0);
    for (std::size_t cell = 0; cell < size(); ++cell) {
      const std::uint32_t label = thinned.cell_labels[cell];
      const Vector<3> mean = thinned.gaussians[label].mean;
      for (std::size_t i = cells_.first_point[cell]; i < cells_.first_point[cell + 1]; ++i) {
        const std::uint32_t index = sorted_.index(i);
        squares[i] = square(points_[index], mean);
        if (labels != nullptr) (*labels)[index] = std::int32_t(label);
        if (samples == nullptr || squares[i] > least[label]) continue;
        if (squares[i] == least[label] && index > (*samples)[label]) continue;
        least[label] = squares[i];
        (*samples)[label] = index;
      }
    }
    if (part_point == PartPoint::Sample)
      for (std::size_t cell = 0; cell < size(); ++cell) {
        const float* const sample = points_[(*samples)[thinned.cell_labels[cell]]];
        const Vector<3> place(sample[0], sample[1], sample[2]);
        for (std::size_t i = cells_.first_point[cell]; i < cells_.first_point[cell + 1]; ++i)
          squares[i] = square(points_[sorted_.index(i)], place);
      }
    return std::sqrt(double(percentile95(squares)));
  }

  static float square(const float* point, const Vector<3>& place) {
    const double dx = double(point[0]) - place[0], dy = double(point[1]) - place[1], dz = double(point[2]) - place[2];
    return float(dx * dx + dy * dy + dz * dz);
  }

  const SortedPoints& sorted_;
  const PointsView& points_;
  SortedCells cells_;
  int bits_;
  std::vector<WardCluster> clusters_;
  std::optional<WardMerges> first_merges_;
};

/// Returns about the smallest number of clusters that keeps the error, or the number of cells if none does.
std::size_t fewestWithin(CloudCells& clusters, double max_error, PartPoint part_point) {
  const auto error = [&](std::size_t count) { return clusters.error(clusters.labels(count), part_point); };
  std::size_t enough = clusters.size(), too_few = 0;
  double error_enough = error(enough), error_too_few = 0.0;
  if (enough <= 1 || error_enough > max_error) return enough;
  if (error(1) <= max_error) return 1;
  too_few = 1;
  while (double(enough) > kWithinFewest * double(too_few) && enough - too_few > 1) {
    // On a surface, the error falls with the square root of the number of clusters.
    const double gap = double(enough) / double(too_few);
    double share = 0.5;
    if (error_too_few > 0.0 && error_enough > 0.0 && error_too_few > error_enough)
      share = std::log(max_error / error_enough) / std::log(error_too_few / error_enough);
    else if (error_enough > 0.0)
      share = 2.0 * std::log(max_error / error_enough) / std::log(gap);
    share = std::clamp(share, 0.02, 0.98);
    auto middle = std::size_t(double(enough) * std::pow(gap, -share));
    middle = std::clamp(middle, too_few + 1, enough - 1);
    const double found = error(middle);
    (found <= max_error ? enough : too_few) = middle;
    (found <= max_error ? error_enough : error_too_few) = found;
  }
  return enough;
}

}  // namespace

ThinnedPoints thinPoints(const PointsView& points, const ThinPointsOptions& options) {
  checkOptions(options);
  const bool has_error = options.max_error > 0.0, has_leaf = options.leaf_size > 0.0;
  const auto budget =
      options.max_gaussians.value_or(has_error || has_leaf ? std::numeric_limits<std::size_t>::max() : kDefaultBudget);
  const double wanted_side = kCellPerError * options.max_error;
  SortedPoints sorted(points, options.leaf_size, points.count < kFewPoints ? kShortCodeOfFew : kShortCode);
  const bool are_many = budget > sorted.size() / kPointsPerGaussianIfMany;
  const double cells = (are_many ? kCellsPerGaussianIfMany : kCellsPerGaussian) * std::min(double(budget), 1e15);
  const auto wanted = std::max(kFewestCells, std::size_t(cells));
  const auto isFineEnough = [&] {
    return has_error ? sorted.side(0) <= wanted_side : sorted.cellCount(0) >= std::min(wanted, sorted.size());
  };
  if (!has_leaf && sorted.size() > 0 && !isFineEnough()) sorted = SortedPoints(points, 0.0, SortedPoints::kMaxBits);

  int level = std::min(options.scale, sorted.bits() - 1);
  if (!has_leaf) level = has_error ? levelFor(sorted, wanted_side) : levelFor(sorted, wanted);
  std::optional<CloudCells> clusters(std::in_place, sorted, points, level);
  std::size_t count = std::min(budget, std::max<std::size_t>(1, clusters->size()));
  if (has_error) {
    std::size_t needed = fewestWithin(*clusters, options.max_error, options.part_point);
    while (!has_leaf && level > 0 && needed == clusters->size() && needed < sorted.size() && needed < budget) {
      clusters.emplace(sorted, points, --level);
      needed = fewestWithin(*clusters, options.max_error, options.part_point);
    }
    count = std::min(budget, std::max<std::size_t>(1, needed));
  }
  std::vector<std::uint32_t> labels = clusters->labels(count);
  ThinnedPoints thinned = std::move(*clusters).thinned(std::move(labels), options.part_point);
  thinned.error_kept = !has_error || thinned.error <= options.max_error;
  return thinned;
}

GaussianMap<3> ThinnedPoints::map() const {
  MapOptions options;
  options.resolution = cell_side;
  options.scales = 2;
  if (keys.empty()) return GaussianMap<3>(options);
  CellKey<3> low = keys.front(), high = low;
  for (const CellKey<3>& key : keys)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], key[axis]);
      high[axis] = std::max(high[axis], key[axis]);
    }
  std::int64_t span = 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    span = std::max(span, std::int64_t{high[axis]} - std::int64_t{low[axis]} + 1);
  options.ratio = 2;
  while (options.ratio < span && options.ratio < (1 << 22)) options.ratio *= 2;
  const Grid<3> grid(options);
  options = grid.options();

  MapScale<3> fine, coarse;
  std::vector<std::uint32_t> last_cell(gaussians.size(), 0xFFFFFFFFu), part(gaussians.size(), 0);
  std::vector<UnionMoments> sums;
  for (const std::uint32_t cell : keyOrder<3>(keys, options.ratio, 1)) {
    const CellKey<3> key = keys[cell], parent = grid.ancestor(key, 0, 1);
    if (coarse.keys.empty() || coarse.keys.back() != parent) {
      coarse.keys.push_back(parent);
      coarse.first_child.push_back(std::uint32_t(fine.keys.size()));
      coarse.first_gaussian.push_back(std::uint32_t(sums.size()));
    }
    const std::uint32_t label = cell_labels[cell];
    if (last_cell[label] != coarse.keys.size()) {
      last_cell[label] = std::uint32_t(coarse.keys.size());
      part[label] = std::uint32_t(sums.size());
      sums.emplace_back();
    }
    sums[part[label]].add(key, moments[cell]);
    fine.keys.push_back(key);
    fine.moments.push_back(moments[cell]);
    fine.parent.push_back(part[label]);
  }
  coarse.first_child.push_back(std::uint32_t(fine.keys.size()));
  coarse.first_gaussian.push_back(std::uint32_t(sums.size()));
  std::size_t cell = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    while (coarse.first_gaussian[cell + 1] <= i) ++cell;
    Gaussian<3> gaussian = sums[i].gaussian(cell_side);
    gaussian.mean -= grid.centre(coarse.keys[cell], 1);
    gaussian.cov.diagonal().array() += options.noise * options.noise;
    coarse.gaussians.push_back(gaussian);
  }
  std::vector<MapScale<3>> scales;
  scales.push_back(std::move(fine));
  scales.push_back(std::move(coarse));
  return GaussianMap<3>(options, std::move(scales));
}

}  // namespace gaussmap
