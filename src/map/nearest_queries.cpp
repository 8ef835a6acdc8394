// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gaussmap/map/queries.h"
#include "map/check_query.h"
#include "map/mean_search.h"
#include "points/nearest_list.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr int kBoxes = 3;        // sizes of the box
constexpr int kMaxInBox = 1000;  // more neighbours need so many cells that the order of the cells matters

template <int D, typename Entries>
std::vector<FoundGaussian> resultOf(const Entries& entries) {
  using Search = MeanSearch<D>;
  std::vector<FoundGaussian> found;
  found.reserve(entries.size());
  for (const auto& entry : entries)
    found.push_back({{Search::scaleOf(entry.index), Search::indexOf(entry.index)}, entry.distance});
  return found;
}

/// Finds the `k` means that are nearest to a point. `List`: NearestOne or NearestList, which `make(limit)` makes. The
/// means are usually in the cells around the point. So the search begins with a small box of cells.
template <int D, typename Make>
auto searchNearest(const GaussianMap<D>& map, const Vector<D>& point, int k, int scale, const Make& make) {
  const MeanSearch<D> search(map, point, scale);
  const double side = map.grid().side(std::max(scale, 0));
  double radius = side * (0.5 + std::sqrt(0.5 * k));  // on a surface there are about 2 k means within it
  for (int round = 0; round < kBoxes && k <= kMaxInBox; ++round, radius *= 2.0) {
    auto list = make(radius);
    search.searchBox(list);
    if (list.full()) return list;
  }
  auto list = make(kAnyDistance);
  search.searchNearFirst(list);
  return list;
}

template <int D>
std::vector<FoundGaussian> nearestMeans(const GaussianMap<D>& map, const Vector<D>& point, int k, int scale) {
  checkQuery(map.grid(), point);
  checkCount(k);
  if (k == 0) return {};
  auto list = searchNearest(map, point, k, scale, [k](double limit) {
    return NearestList<double, std::uint64_t>(static_cast<std::size_t>(k), limit);
  });
  return resultOf<D>(list.sort());
}

template <int D>
std::vector<FoundGaussian> meansWithin(const GaussianMap<D>& map, const Vector<D>& point, double radius, int scale) {
  checkQuery(map.grid(), point);
  checkRadius(radius);
  NeighboursWithin<double, std::uint64_t> list(radius);
  MeanSearch<D>(map, point, scale).searchBox(list);
  return resultOf<D>(list.sort());
}

}  // namespace

template <int D>
std::optional<NearestGaussian<D>> nearest(const GaussianMap<D>& map, const Vector<D>& point, int scale) {
  checkScale(map, scale);
  checkQuery(map.grid(), point);
  if (map.cellCount(scale) == 0) return std::nullopt;
  const auto one =
      searchNearest(map, point, 1, scale, [](double limit) { return NearestOne<double, std::uint64_t>(limit); });
  return NearestGaussian<D>{MeanSearch<D>::indexOf(one.best().index), one.best().distance};
}

template <int D>
std::vector<FoundGaussian> nearestK(const GaussianMap<D>& map, const Vector<D>& point, int k, int scale) {
  checkScale(map, scale);
  return nearestMeans(map, point, k, scale);
}

template <int D>
std::vector<FoundGaussian> within(const GaussianMap<D>& map, const Vector<D>& point, double radius, int scale) {
  checkScale(map, scale);
  return meansWithin(map, point, radius, scale);
}

template <int D>
std::vector<FoundGaussian> nearestLeaves(const GaussianMap<D>& map, const Vector<D>& point, int k) {
  return nearestMeans(map, point, k, MeanSearch<D>::kLeaves);
}

template <int D>
std::vector<FoundGaussian> leavesWithin(const GaussianMap<D>& map, const Vector<D>& point, double radius) {
  return meansWithin(map, point, radius, MeanSearch<D>::kLeaves);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                          \
  template std::optional<NearestGaussian<(D)>> nearest<D>(const GaussianMap<D>&, const Vector<D>&, int); \
  template std::vector<FoundGaussian> nearestK<D>(const GaussianMap<D>&, const Vector<D>&, int, int);    \
  template std::vector<FoundGaussian> within<D>(const GaussianMap<D>&, const Vector<D>&, double, int);   \
  template std::vector<FoundGaussian> nearestLeaves<D>(const GaussianMap<D>&, const Vector<D>&, int);    \
  template std::vector<FoundGaussian> leavesWithin<D>(const GaussianMap<D>&, const Vector<D>&, double);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
