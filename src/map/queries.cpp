// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/queries.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "map/neighbour_keys.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Calls visit(index) for every Gaussian of a scale in the leaves.
template <int D, typename Visit>
void forEachLeaf(const GaussianMap<D>& map, int scale, const Visit& visit) {
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) {
    if (!map.isLeaf(cell, scale)) continue;
    const IndexRange range = map.gaussiansOf(cell, scale);
    for (std::size_t i = range.first; i < range.last; ++i) visit(i);
  }
}

template <int D>
std::optional<CellKey<D>> cellOf(const GaussianMap<D>& map, const Vector<D>& point) {
  if (!point.allFinite()) return std::nullopt;
  try {
    return map.grid().keyOf(point);
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

/// Calls visit(cell) for every occupied cell of the 3^D cells around a key.
template <int D, typename Visit>
void forEachNeighbour(const GaussianMap<D>& map, const CellKey<D>& centre, int scale, const Visit& visit) {
  forKeysAround(centre, [&](const CellKey<D>& key) {
    if (const auto cell = map.find(key, scale)) visit(*cell);
  });
}

/// Appends ln(weight * density at the point) for each Gaussian of a cell.
template <int D>
void addTerms(const GaussianMap<D>& map, const Vector<D>& point, std::size_t cell, int scale,
              std::vector<double>& terms) {
  const Vector<D> local = point - map.grid().centre(map.scale(scale).keys[cell], scale);
  const IndexRange range = map.gaussiansOf(cell, scale);
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Gaussian<D> gaussian = map.localGaussian(i, scale);
    terms.push_back(std::log(gaussian.weight) + logDensity<D>(local, gaussian));
  }
}

/// Returns ln(sum of e^term / weight); minus infinity if there are no terms.
double logOfMixture(const std::vector<double>& terms, double weight) {
  if (terms.empty()) return -std::numeric_limits<double>::infinity();
  double largest = terms.front();
  for (double term : terms) largest = std::max(largest, term);
  double sum = 0.0;
  for (double term : terms) sum += std::exp(term - largest);
  return largest + std::log(sum) - std::log(weight);
}

}  // namespace

template <int D>
std::vector<GaussianId> gaussiansOfScale(const GaussianMap<D>& map, int scale) {
  if (scale < 0 || scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(scale) + ": the number of scales of the map is " +
                            std::to_string(map.scales()));
  std::vector<GaussianId> all(map.gaussianCount(scale));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = {scale, i};
  return all;
}

template <int D>
std::vector<GaussianId> leaves(const GaussianMap<D>& map) {
  std::vector<GaussianId> found;
  for (int s = 0; s < map.scales(); ++s) forEachLeaf(map, s, [&](std::size_t i) { found.push_back({s, i}); });
  return found;
}

template <int D>
LeafCounts leafCounts(const GaussianMap<D>& map, int scale) {
  LeafCounts counts;
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) counts.cells += map.isLeaf(cell, scale) ? 1 : 0;
  forEachLeaf(map, scale, [&](std::size_t i) {
    ++counts.gaussians;
    counts.weight += map.localGaussian(i, scale).weight;
  });
  return counts;
}

template <int D>
std::optional<Box<D>> extentOf(const GaussianMap<D>& map) {
  std::optional<Box<D>> extent;
  for (int s = 0; s < map.scales(); ++s)
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      if (!map.isLeaf(cell, s)) continue;
      const Box<D> box = map.grid().boxOf(map.scale(s).keys[cell], s);
      extent = extent ? Box<D>{extent->low.cwiseMin(box.low), extent->high.cwiseMax(box.high)} : box;
    }
  return extent;
}

template <int D>
double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point, int scale) {
  std::vector<double> terms;
  forEachNeighbour<D>(map, map.grid().keyOf(point, scale), scale,
                      [&](std::size_t cell) { addTerms<D>(map, point, cell, scale, terms); });
  return logOfMixture(terms, map.weight(scale));
}

template <int D>
double logLikelihood(const GaussianMap<D>& map, const Vector<D>& point) {
  std::vector<double> terms;
  for (int scale = 0; scale < map.scales(); ++scale)
    forEachNeighbour<D>(map, map.grid().keyOf(point, scale), scale, [&](std::size_t cell) {
      if (map.isLeaf(cell, scale)) addTerms<D>(map, point, cell, scale, terms);
    });
  return logOfMixture(terms, map.weight(map.scales() - 1));
}

template <int D>
std::optional<Vector<D>> normalAt(const GaussianMap<D>& map, const Vector<D>& point) {
  for (int scale = 0; scale < map.scales(); ++scale) {
    const auto cell = map.find(map.grid().keyOf(point, scale), scale);
    if (!cell) continue;
    const Vector<D> local = point - map.grid().centre(map.scale(scale).keys[*cell], scale);
    const IndexRange range = map.gaussiansOf(*cell, scale);
    Gaussian<D> chosen;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Gaussian<D> gaussian = map.localGaussian(i, scale);
      const double distance = mahalanobisSquared<D>(local, gaussian) + logDeterminant<D>(gaussian.cov);  // eq. (2)
      if (distance < least) {
        least = distance;
        chosen = gaussian;
      }
    }
    if (chosen.weight < D + 1) continue;
    const PrincipalAxes<D> axes = principalAxes<D>(chosen);
    if (axes.variances(1) >= 16.0 * map.options().noise * map.options().noise) return axes.normal();
  }
  return std::nullopt;
}

template <int D>
std::optional<float> logOddsAt(const GaussianMap<D>& map, const Vector<D>& point) {
  const auto key = cellOf(map, point);
  if (!key) return std::nullopt;
  for (int s = 0; s < map.scales(); ++s) {
    const auto cell = map.find(map.grid().ancestor(*key, 0, s), s);
    if (!cell) continue;
    if (!map.isLeaf(*cell, s)) return std::nullopt;  // no finer cell contains the point
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    const IndexRange all = map.gaussiansOf(*cell, s);
    for (std::size_t i = all.first; i < all.last; ++i) {
      const double square = all.size() == 1 ? 0.0 : mahalanobisSquared<D>(point, map.gaussian(i, s));
      if (square >= least) continue;
      least = square;
      nearest = i;
    }
    return map.logOdds(nearest, s);
  }
  return std::nullopt;
}

#define GAUSSMAP_INSTANTIATE(D)                                                             \
  template std::vector<GaussianId> gaussiansOfScale<D>(const GaussianMap<D>&, int);         \
  template std::vector<GaussianId> leaves<D>(const GaussianMap<D>&);                        \
  template LeafCounts leafCounts<D>(const GaussianMap<D>&, int);                            \
  template std::optional<Box<(D)>> extentOf<D>(const GaussianMap<D>&);                      \
  template double logLikelihood<D>(const GaussianMap<D>&, const Vector<D>&, int);           \
  template double logLikelihood<D>(const GaussianMap<D>&, const Vector<D>&);                \
  template std::optional<Vector<(D)>> normalAt<D>(const GaussianMap<D>&, const Vector<D>&); \
  template std::optional<float> logOddsAt<D>(const GaussianMap<D>&, const Vector<D>&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
