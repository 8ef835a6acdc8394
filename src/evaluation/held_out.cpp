// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/evaluation/held_out.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/check.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "map/neighbour_keys.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kLogTwoPi = 1.8378770664093454836;
constexpr double kNothing = -std::numeric_limits<double>::infinity();
constexpr double kNegligible = 45.0;    // [nat]; e^-45 of a sum is below the precision of a double
constexpr std::size_t kGrain = 4096;    // points or Gaussians per task; maximum size of a PointsOfCell
constexpr std::size_t kCellGrain = 16;  // cells per task

/// A Gaussian prepared for evaluation: ln(w N(x; mu, Sigma)) = constant - |whiten (x - mu)|^2 / 2.
template <int D>
struct Factorised {
  Vector<D> mean;    // [m], relative to the centre of its cell
  Matrix<D> whiten;  // inverse of the lower Cholesky factor, also a lower triangle
  double constant;

  double logTerm(const Vector<D>& local) const {
    const Vector<D> offset = local - mean;
    double square = 0.0;
    for (int row = 0; row < D; ++row) {
      double sum = 0.0;
      for (int column = 0; column <= row; ++column) sum += whiten(row, column) * offset(column);
      square += sum * sum;
    }
    return constant - 0.5 * square;
  }
};

template <int D>
std::vector<Factorised<D>> factorise(const GaussianMap<D>& map, int scale, int threads) {
  std::vector<Factorised<D>> all(map.gaussianCount(scale));
  parallelFor(all.size(), threads, kGrain, [&](std::size_t i) {
    const Gaussian<D> gaussian = map.localGaussian(i, scale);
    const Eigen::LLT<Matrix<D>> llt(gaussian.cov);
    if (!gaussian.cov.allFinite() || llt.info() != Eigen::Success)
      throw std::domain_error("covariance is not positive definite; add a noise floor to its eigenvalues");
    const Matrix<D> factor = llt.matrixL();
    all[i] = {gaussian.mean, factor.template triangularView<Eigen::Lower>().solve(Matrix<D>::Identity()),
              std::log(gaussian.weight) - factor.diagonal().array().log().sum() - 0.5 * D * kLogTwoPi};
  });
  return all;
}

/// The index of a point in the input, and the cell that contains the point.
template <int D>
struct PlacedPoint {
  CellKey<D> key;
  std::uint32_t index;
};

/// A range of the sorted points: all points of one cell, or some of them.
template <int D>
struct PointsOfCell {
  CellKey<D> key;
  std::size_t first, last;
};

template <int D>
std::vector<PlacedPoint<D>> sortByCell(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& points,
                                       int threads) {
  if (points.size() > 0xFFFFFFFFu) throw std::invalid_argument("more than 2^32 - 1 points");
  std::vector<PlacedPoint<D>> placed(points.size());
  parallelFor(points.size(), threads, kGrain, [&](std::size_t i) {
    placed[i] = {map.grid().keyOf(points[i], scale), static_cast<std::uint32_t>(i)};
  });
  std::sort(placed.begin(), placed.end(), [](const PlacedPoint<D>& a, const PlacedPoint<D>& b) {
    return std::tie(a.key, a.index) < std::tie(b.key, b.index);
  });
  return placed;
}

template <int D>
std::vector<PointsOfCell<D>> cellsOf(const std::vector<PlacedPoint<D>>& placed) {
  std::vector<PointsOfCell<D>> cells;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (cells.empty() || cells.back().key != placed[i].key || i - cells.back().first == kGrain)
      cells.push_back({placed[i].key, i, i});
    cells.back().last = i + 1;
  }
  return cells;
}

/// An occupied cell among the 3^D cells around a key.
template <int D>
struct Neighbour {
  Vector<D> centre;  // [m]
  IndexRange gaussians;
  bool is_own;  // the cell of the key itself
};

enum class Cells { All, Leaves };

template <int D>
std::vector<Neighbour<D>> neighbours(const GaussianMap<D>& map, int scale, Cells cells, const CellKey<D>& key) {
  std::vector<Neighbour<D>> found;
  forKeysAround(key, [&](const CellKey<D>& other) {
    const auto cell = map.find(other, scale);
    if (cell && (cells == Cells::All || map.isLeaf(*cell, scale)))
      found.push_back({map.grid().centre(other, scale), map.gaussiansOf(*cell, scale), other == key});
  });
  return found;
}

template <int D>
double logOfSum(const std::vector<Neighbour<D>>& around, const std::vector<Factorised<D>>& gaussians,
                const Vector<D>& point, std::vector<double>& terms) {
  terms.clear();
  double largest = kNothing;
  for (const Neighbour<D>& cell : around) {
    const Vector<D> local = point - cell.centre;
    for (std::size_t i = cell.gaussians.first; i < cell.gaussians.last; ++i) {
      terms.push_back(gaussians[i].logTerm(local));
      largest = std::max(largest, terms.back());
    }
  }
  if (largest == kNothing) return kNothing;
  double sum = 0.0;
  for (const double term : terms)
    if (term > largest - kNegligible) sum += std::exp(term - largest);
  return largest + std::log(sum);
}

void checkOptions(const HeldOutOptions& options) {
  require(options.background > 0.0 && options.background < 1.0, "background", options.background,
          "must be above 0 and below 1");
  require(options.volume >= 0.0 && std::isfinite(options.volume), "volume", options.volume,
          "must be positive and finite (0 = the box around the points)");
}

template <int D>
double boxVolume(const std::vector<Vector<D>>& points) {
  Vector<D> low = points.front(), high = low;
  for (const Vector<D>& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).cwiseMax(1.0).prod();
}

/// ln(e^a + e^b).
double logOfBoth(double a, double b) {
  const double large = std::max(a, b), small = std::min(a, b);
  return large + std::log1p(std::exp(small - large));
}

/// Per point: ln of the mixture density there, and whether the point lies in an occupied cell.
struct Scores {
  std::vector<double> values;
  std::vector<char> in_cell;
};

/// Scores the points with the mixture of one scale, or of its leaves. Divides all weights by `weight`.
template <int D>
Scores scoreScale(const GaussianMap<D>& map, int scale, Cells which, double weight,
                  const std::vector<Vector<D>>& points, int threads) {
  const std::vector<PlacedPoint<D>> placed = sortByCell<D>(map, scale, points, threads);
  const std::vector<PointsOfCell<D>> cells = cellsOf<D>(placed);
  const std::vector<Factorised<D>> gaussians = factorise<D>(map, scale, threads);
  const double log_weight = std::log(weight);
  Scores scores{std::vector<double>(points.size(), kNothing), std::vector<char>(points.size(), false)};
  parallelFor(cells.size(), threads, kCellGrain, [&](std::size_t c) {
    const std::vector<Neighbour<D>> around = neighbours<D>(map, scale, which, cells[c].key);
    const bool occupied =
        std::any_of(around.begin(), around.end(), [](const Neighbour<D>& cell) { return cell.is_own; });
    if (around.empty()) return;
    std::vector<double> terms;
    for (std::size_t i = cells[c].first; i < cells[c].last; ++i) {
      scores.values[placed[i].index] = logOfSum<D>(around, gaussians, points[placed[i].index], terms) - log_weight;
      scores.in_cell[placed[i].index] = occupied;
    }
  });
  return scores;
}

template <int D>
Scores score(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& points, int threads) {
  if (scale < 0 || scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(scale) + ": the map has the scales 0 to " +
                            std::to_string(map.scales() - 1));
  return scoreScale<D>(map, scale, Cells::All, map.weight(scale), points, threads);
}

template <int D>
Scores scoreLeaves(const GaussianMap<D>& map, const std::vector<Vector<D>>& points, int threads) {
  const double weight = map.weight(map.scales() - 1);
  Scores scores = scoreScale<D>(map, 0, Cells::Leaves, weight, points, threads);
  if (!map.isCompressed()) return scores;
  for (int s = 1; s < map.scales(); ++s) {
    const Scores coarser = scoreScale<D>(map, s, Cells::Leaves, weight, points, threads);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (coarser.values[i] == kNothing) continue;
      scores.values[i] =
          scores.values[i] == kNothing ? coarser.values[i] : logOfBoth(scores.values[i], coarser.values[i]);
      scores.in_cell[i] |= coarser.in_cell[i];
    }
  }
  return scores;
}

HeldOutResult summarise(Scores scores, double volume, const HeldOutOptions& options) {
  std::vector<double>& values = scores.values;
  HeldOutResult result;
  result.count = values.size();
  result.in_no_cell = static_cast<std::size_t>(std::count(scores.in_cell.begin(), scores.in_cell.end(), false));
  result.volume = volume;
  result.floor = std::log(options.background) - std::log(result.volume);
  double sum = 0.0, sum_inside = 0.0;
  for (double& value : values) {
    if (value == kNothing) {
      ++result.nowhere;
      value = result.floor;
    } else {
      sum_inside += value;
      value = logOfBoth(std::log1p(-options.background) + value, result.floor);
    }
    sum += value;
  }
  result.mean = sum / static_cast<double>(result.count);
  result.mean_inside = sum_inside / static_cast<double>(result.count - result.nowhere);  // 0 / 0 gives NaN
  result.median = percentile(values, 50);
  return result;
}

/// Returns the volume V [m^D]. Throws std::invalid_argument if there are no points, or if an option is not valid.
template <int D>
double volumeOf(const std::vector<Vector<D>>& points, const HeldOutOptions& options) {
  checkOptions(options);
  if (points.empty()) throw std::invalid_argument("no points to score the map with");
  return options.volume > 0.0 ? options.volume : boxVolume<D>(points);
}

}  // namespace

template <int D>
std::vector<double> logLikelihoods(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& points,
                                   int threads) {
  return score<D>(map, scale, points, threads).values;
}

template <int D>
std::vector<double> logLikelihoods(const GaussianMap<D>& map, const std::vector<Vector<D>>& points, int threads) {
  return scoreLeaves<D>(map, points, threads).values;
}

template <int D>
HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& points,
                                   const HeldOutOptions& options) {
  const double volume = volumeOf<D>(points, options);
  return summarise(score<D>(map, scale, points, options.threads), volume, options);
}

template <int D>
HeldOutResult heldOutLogLikelihood(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                                   const HeldOutOptions& options) {
  const double volume = volumeOf<D>(points, options);
  return summarise(scoreLeaves<D>(map, points, options.threads), volume, options);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                     \
  template std::vector<double> logLikelihoods<D>(const GaussianMap<D>&, int, const std::vector<Vector<(D)>>&, int); \
  template std::vector<double> logLikelihoods<D>(const GaussianMap<D>&, const std::vector<Vector<(D)>>&, int);      \
  template HeldOutResult heldOutLogLikelihood<D>(const GaussianMap<D>&, int, const std::vector<Vector<(D)>>&,       \
                                                 const HeldOutOptions&);                                            \
  template HeldOutResult heldOutLogLikelihood<D>(const GaussianMap<D>&, const std::vector<Vector<(D)>>&,            \
                                                 const HeldOutOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
