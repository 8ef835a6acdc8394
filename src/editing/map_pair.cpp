// SPDX-License-Identifier: BSD-3-Clause
#include "editing/map_pair.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "map/map_scale_builder.h"

namespace gaussmap::detail {
namespace {

template <int D>
void pairCells(const GaussianMap<D>& a, const GaussianMap<D>& b, int s, IndexRange in_a, IndexRange in_b,
               std::vector<CellPair>& pairs) {
  const std::vector<CellKey<D>>&keys_a = a.scale(s).keys, &keys_b = b.scale(s).keys;
  while (!in_a.empty() || !in_b.empty()) {
    const bool from_a = !in_a.empty() && (in_b.empty() || !(keys_b[in_b.first] < keys_a[in_a.first]));
    const bool from_b = !in_b.empty() && (in_a.empty() || !(keys_a[in_a.first] < keys_b[in_b.first]));
    CellPair pair;
    if (from_a) pair.a = in_a.first++;
    if (from_b) pair.b = in_b.first++;
    pairs.push_back(pair);
  }
}

/// Compares the values of two Gaussians. A sort by this order does not depend on which map is first.
template <int D>
bool before(const SourceGaussian<D>& p, const SourceGaussian<D>& q) {
  const auto numbers = [](const SourceGaussian<D>& source) {
    std::array<double, 1 + D + D * D> all{source.gaussian.weight};
    std::copy_n(source.gaussian.mean.data(), D, all.begin() + 1);
    std::copy_n(source.gaussian.cov.data(), D * D, all.begin() + 1 + D);
    return all;
  };
  return numbers(p) < numbers(q);
}

}  // namespace

template <int D>
MapPair<D>::MapPair(const GaussianMap<D>& a, const GaussianMap<D>& b)
    : a_(a), b_(b), cells_(static_cast<std::size_t>(a.scales())), first_child_(cells_.size()) {
  const int coarsest = a.scales() - 1;
  pairCells(a, b, coarsest, {0, a.cellCount(coarsest)}, {0, b.cellCount(coarsest)}, cells_.back());
  for (int s = coarsest; s > 0; --s) {
    std::vector<CellPair>& children = cells_[static_cast<std::size_t>(s) - 1];
    std::vector<std::uint32_t>& first = first_child_[static_cast<std::size_t>(s)];
    for (const CellPair& above : cells(s)) {
      first.push_back(static_cast<std::uint32_t>(children.size()));
      if (above.a && above.b && (a.isLeaf(*above.a, s) || b.isLeaf(*above.b, s))) continue;
      pairCells(a, b, s - 1, above.a ? a.childCells(*above.a, s) : IndexRange{},
                above.b ? b.childCells(*above.b, s) : IndexRange{}, children);
    }
  }
}

template <int D>
std::size_t MapPair<D>::countIn(const CellPair& pair, int s) const {
  return std::max(pair.a ? a_.gaussiansOf(*pair.a, s).size() : 0, pair.b ? b_.gaussiansOf(*pair.b, s).size() : 0);
}

template <int D>
std::vector<SourceGaussian<D>> MapPair<D>::sourcesIn(const CellPair& pair, int s) const {
  std::vector<SourceGaussian<D>> sources;
  const auto add = [&](const GaussianMap<D>& map, const std::optional<std::size_t>& cell, bool in_b) {
    if (!cell) return;
    const IndexRange range = map.gaussiansOf(*cell, s);
    for (std::size_t i = range.first; i < range.last; ++i)
      sources.push_back({map.localGaussian(i, s), map.logOdds(i, s), in_b, i});
  };
  add(a_, pair.a, false);
  add(b_, pair.b, true);
  std::sort(sources.begin(), sources.end(), before<D>);
  return sources;
}

template <int D>
float MapPair<D>::combined(std::optional<float> in_a, std::optional<float> in_b) const {
  if (!in_a || !in_b) return in_a ? *in_a : *in_b;
  if (!a_.hasOccupancy()) return *in_b;
  if (!b_.hasOccupancy()) return *in_a;
  return std::clamp(*in_a + *in_b, -kMaxOccupancy, kMaxOccupancy);
}

template <int D>
float MapPair<D>::combined(const std::vector<SourceGaussian<D>>& sources, const std::vector<int>& label,
                           int part) const {
  std::optional<float> in_a, in_b;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (label[i] != part) continue;
    std::optional<float>& highest = sources[i].in_b ? in_b : in_a;
    highest = highest ? std::max(*highest, sources[i].log_odds) : sources[i].log_odds;
  }
  return combined(in_a, in_b);
}

template <int D>
MapScale<D> MapPair<D>::addMoments() const {
  MapScaleBuilder<D> finest;
  finest.reserveMoments(cells(0).size());
  for (const CellPair& pair : cells(0)) {
    finest.addCell(keyOf(pair, 0));
    CellMoments<D> moments;
    if (pair.a) moments = a_.scale(0).moments[*pair.a];
    if (pair.b) {
      const CellMoments<D>& more = b_.scale(0).moments[*pair.b];
      if (more.count > CellMoments<D>::kMaxPoints - moments.count)
        throw std::invalid_argument("cell " + toString<D>(finest.key()) + " would hold " +
                                    std::to_string(moments.count + more.count) +
                                    " points, more than 2^33 - 1: take finer cells");
      moments += more;
    }
    finest.addMoments(moments);
    if (!hasOccupancy()) continue;
    const auto logOdds = [](const GaussianMap<D>& map, const std::optional<std::size_t>& cell) {
      return cell ? std::optional<float>(map.logOdds(*cell, 0)) : std::nullopt;
    };
    finest.addLogOdds(combined(logOdds(a_, pair.a), logOdds(b_, pair.b)));
  }
  return finest.take();
}

template class MapPair<2>;
template class MapPair<3>;

}  // namespace gaussmap::detail
