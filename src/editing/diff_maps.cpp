// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/diff_maps.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>

#include "core/check.h"
#include "core/parallel.h"
#include "core/pi.h"
#include "map/neighbour_keys.h"

namespace gaussmap {
using namespace detail;

namespace {

/// P(chi^2_D >= x).
template <int D>
double chiSquaredTail(double x) {
  const double tail = std::exp(-0.5 * x);
  if constexpr (D == 2) return tail;
  return std::erfc(std::sqrt(0.5 * x)) + std::sqrt(2.0 * x / kPi) * tail;
}

/// Compares the Gaussians of one map with those of another.
template <int D>
class MapComparison {
 public:
  MapComparison(const GaussianMap<D>& map, const GaussianMap<D>& other, const DiffOptions& options)
      : map_(map), other_(other), options_(options), prior_(map.grid().side(options.scale)) {
    prior_ *= prior_ / 12.0;
  }

  /// Returns the p-value of the test that Gaussian `ours` and Gaussian `theirs` of the other map have the same mean.
  /// `shift` = vector from the cell of `ours` to the cell of `theirs` [m].
  double pValue(std::size_t ours, std::size_t theirs, const Vector<D>& shift) const {
    const Gaussian<D> p = map_.localGaussian(ours, options_.scale), q = other_.localGaussian(theirs, options_.scale);
    const Matrix<D> cov = covarianceOfMean(p) + covarianceOfMean(q);
    const Vector<D> difference = q.mean - p.mean + shift;
    return chiSquaredTail<D>(Eigen::LLT<Matrix<D>>(cov).matrixL().solve(difference).squaredNorm());
  }

  /// Returns per Gaussian the p-value of the most similar Gaussian of the other map. The own cell is searched first,
  /// then the adjacent cells. The search ends at the first p-value of at least the significance level. The result is 0
  /// if the other map has no Gaussian in these cells.
  std::vector<double> pValues() const {
    std::vector<double> best(map_.gaussianCount(options_.scale), 0.0);
    parallelFor(map_.cellCount(options_.scale), options_.threads, 64, [&](std::size_t cell) {
      const CellKey<D>& key = map_.scale(options_.scale).keys[cell];
      const IndexRange ours = map_.gaussiansOf(cell, options_.scale);
      const auto compare = [&](const CellKey<D>& with) {
        const auto found = other_.find(with, options_.scale);
        if (!found) return;
        Vector<D> shift;
        for (std::size_t axis = 0; axis < D; ++axis)
          shift(Eigen::Index(axis)) = map_.grid().side(options_.scale) *
                                      static_cast<double>(std::int64_t{with[axis]} - std::int64_t{key[axis]});
        const IndexRange theirs = other_.gaussiansOf(*found, options_.scale);
        for (std::size_t i = ours.first; i < ours.last; ++i)
          for (std::size_t j = theirs.first; j < theirs.last && best[i] < options_.level; ++j)
            best[i] = std::max(best[i], pValue(i, j, shift));
      };
      compare(key);
      if (std::any_of(best.begin() + static_cast<std::ptrdiff_t>(ours.first),
                      best.begin() + static_cast<std::ptrdiff_t>(ours.last),
                      [&](double p) { return p < options_.level; }))
        forNearKeys(key, 1, 1, compare);
    });
    return best;
  }

 private:
  Matrix<D> covarianceOfMean(const Gaussian<D>& gaussian) const {
    const double n = gaussian.weight;
    return (n * gaussian.cov + prior_ * Matrix<D>::Identity()) / ((n + 1.0) * std::min(n, options_.points));
  }

  const GaussianMap<D>&map_, &other_;
  const DiffOptions& options_;
  double prior_;  // variance of a uniform distribution over a cell, per axis [m^2]
};

/// Returns the fraction of the points that the first map has in the cells that both maps have; 0.5 without such cells.
template <int D>
double shareOfFirst(const GaussianMap<D>& first, const GaussianMap<D>& second, int s) {
  double in_first = 0.0, in_second = 0.0;
  const auto weightOf = [s](const GaussianMap<D>& map, std::size_t cell) {
    double sum = 0.0;
    const IndexRange range = map.gaussiansOf(cell, s);
    for (std::size_t i = range.first; i < range.last; ++i) sum += map.localGaussian(i, s).weight;
    return sum;
  };
  for (std::size_t cell = 0; cell < first.cellCount(s); ++cell) {
    const auto partner = second.find(first.scale(s).keys[cell], s);
    if (!partner) continue;
    in_first += weightOf(first, cell);
    in_second += weightOf(second, *partner);
  }
  return in_first > 0.0 ? in_first / (in_first + in_second) : 0.5;
}

/// Returns the Gaussians of a cell that differ from all nearby Gaussians of the other map.
std::vector<std::size_t> unexplained(const std::vector<double>& p_values, IndexRange range, double level) {
  std::vector<std::size_t> left;
  for (std::size_t i = range.first; i < range.last; ++i)
    if (p_values[i] < level) left.push_back(i);
  return left;
}

template <int D>
void check(const GaussianMap<D>& first, const GaussianMap<D>& second, const DiffOptions& options) {
  const int s = options.scale;
  require(s >= 0 && s < first.scales() && s < second.scales(), "scale", s, "must be a scale of both maps");
  require(options.level > 0.0 && options.level < 1.0, "level", options.level, "must lie between 0 and 1");
  require(options.points >= 1.0, "points", options.points, "must be at least 1");
  require(options.threads >= 0, "threads", options.threads, "must be at least 1 (0 = all cores)");
  if (first.grid().side(s) == second.grid().side(s)) return;
  std::ostringstream text;
  text << "cells of " << first.grid().side(s) << " m and of " << second.grid().side(s) << " m at scale " << s
       << ": maps of different grids cannot be compared cell by cell";
  throw std::invalid_argument(text.str());
}

}  // namespace

std::size_t MapDiff::count(Change change) const {
  const std::vector<Difference>& from = change == Change::Gone ? first : second;
  return static_cast<std::size_t>(
      std::count_if(from.begin(), from.end(), [&](const Difference& one) { return one.change == change; }));
}

template <int D>
MapDiff diffMaps(const GaussianMap<D>& first, const GaussianMap<D>& second, const DiffOptions& options) {
  check(first, second, options);
  const int s = options.scale;
  const MapComparison<D> from_first(first, second, options), from_second(second, first, options);
  const std::vector<double> p_first = from_first.pValues(), p_second = from_second.pValues();
  MapDiff diff{std::vector<Difference>(p_first.size()), std::vector<Difference>(p_second.size())};
  for (std::size_t i = 0; i < p_first.size(); ++i) diff.first[i].p_value = p_first[i];
  for (std::size_t i = 0; i < p_second.size(); ++i) diff.second[i].p_value = p_second[i];

  const double share = shareOfFirst(first, second, s);
  const auto decide = [&](const GaussianMap<D>& map, std::size_t i, double part, Change change, Difference& one) {
    one.p_value = std::pow(part, map.localGaussian(i, s).weight);
    one.change = one.p_value < options.level ? change : Change::None;
  };
  for (std::size_t cell = 0; cell < first.cellCount(s); ++cell) {
    const std::vector<std::size_t> left = unexplained(p_first, first.gaussiansOf(cell, s), options.level);
    if (left.empty()) continue;
    const auto there = second.find(first.scale(s).keys[cell], s);
    struct Pair {
      double p_value;
      std::size_t ours, theirs;
    };
    std::vector<Pair> pairs;
    if (there)
      for (const std::size_t j : unexplained(p_second, second.gaussiansOf(*there, s), options.level))
        for (const std::size_t i : left) pairs.push_back({from_first.pValue(i, j, Vector<D>::Zero()), i, j});
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
      return std::tie(b.p_value, a.ours, a.theirs) < std::tie(a.p_value, b.ours, b.theirs);
    });
    for (const Pair& pair : pairs) {
      Difference &ours = diff.first[pair.ours], &theirs = diff.second[pair.theirs];
      if (ours.change == Change::None && theirs.change == Change::None) ours = theirs = {Change::Changed, pair.p_value};
    }
    for (const std::size_t i : left)
      if (diff.first[i].change == Change::None) decide(first, i, share, Change::Gone, diff.first[i]);
  }
  for (std::size_t i = 0; i < p_second.size(); ++i)
    if (p_second[i] < options.level && diff.second[i].change == Change::None)
      decide(second, i, 1.0 - share, Change::New, diff.second[i]);
  return diff;
}

template MapDiff diffMaps<2>(const GaussianMap<2>&, const GaussianMap<2>&, const DiffOptions&);
template MapDiff diffMaps<3>(const GaussianMap<3>&, const GaussianMap<3>&, const DiffOptions&);

}  // namespace gaussmap
