// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/merge_maps.h"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "editing/recluster.h"
#include "map/map_scale_builder.h"
#include "map/occupied_areas.h"
#include "mapping/clustering_noise.h"

namespace gaussmap {
using namespace detail;

namespace {

/// A cell of the merged map: its index in each of the two maps, std::nullopt if the map does not have it.
struct CellPair {
  std::optional<std::size_t> a, b;
};

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

/// Returns the cells of every scale of the merged map, in key order, so the children of a cell are consecutive.
template <int D>
std::vector<std::vector<CellPair>> pairCells(const GaussianMap<D>& a, const GaussianMap<D>& b) {
  const int coarsest = a.scales() - 1;
  std::vector<std::vector<CellPair>> pairs(static_cast<std::size_t>(a.scales()));
  pairCells(a, b, coarsest, {0, a.cellCount(coarsest)}, {0, b.cellCount(coarsest)}, pairs.back());
  for (int s = coarsest; s > 0; --s)
    for (const CellPair& above : pairs[static_cast<std::size_t>(s)])
      pairCells(a, b, s - 1, above.a ? a.childCells(*above.a, s) : IndexRange{},
                above.b ? b.childCells(*above.b, s) : IndexRange{}, pairs[static_cast<std::size_t>(s) - 1]);
  return pairs;
}

/// A Gaussian of one of the two maps.
template <int D>
struct Source {
  Gaussian<D> gaussian;  // mean about the centre of its cell
  float log_odds;
  bool in_b;
  std::uint32_t group;  // parentGroup() of the Gaussian
};

/// Compares the values of two Gaussians. A sort by this order does not depend on which map is first.
template <int D>
bool before(const Source<D>& p, const Source<D>& q) {
  const auto numbers = [](const Source<D>& source) {
    std::array<double, 1 + D + D * D> all{source.gaussian.weight};
    std::copy_n(source.gaussian.mean.data(), D, all.begin() + 1);
    std::copy_n(source.gaussian.cov.data(), D * D, all.begin() + 1 + D);
    return all;
  };
  return numbers(p) < numbers(q);
}

template <int D>
class MapMerger {
 public:
  MapMerger(const GaussianMap<D>& a, const GaussianMap<D>& b, const MergeMapsOptions& options)
      : a_(a),
        b_(b),
        options_(options),
        exact_(a.acceptsScans() && b.acceptsScans()),
        is_refined_(isRefined(a) || isRefined(b)),
        pairs_(pairCells(a, b)) {}

  GaussianMap<D> run() const {
    std::vector<std::uint32_t> group;  // per Gaussian of the latest scale: its old cluster at the next coarser scale
    std::vector<MapScale<D>> scales;
    scales.push_back(exact_ ? addMoments(group) : mergeGaussians(group));
    std::vector<double> areas = finestAreas(scales.front());
    for (int s = 1; s < a_.scales(); ++s) scales.push_back(coarseScale(scales.back(), s, group, areas));
    return GaussianMap<D>(a_.options(), std::move(scales));
  }

 private:
  static bool isRefined(const GaussianMap<D>& map) {
    for (int s = 1; s < map.scales(); ++s)
      if (map.gaussianCount(s) > map.cellCount(s)) return true;
    return false;
  }
  const std::vector<CellPair>& pairs(int s) const { return pairs_[static_cast<std::size_t>(s)]; }
  const CellKey<D>& keyOf(const CellPair& pair, int s) const {
    return pair.a ? a_.scale(s).keys[*pair.a] : b_.scale(s).keys[*pair.b];
  }
  bool knowsOccupancy() const { return a_.hasOccupancy() || b_.hasOccupancy(); }

  /// Returns the log-odds of a cell or cluster from its log-odds in each map: their sum, within the limits, if both
  /// maps have it and have occupancy. Otherwise the value of one map is used.
  float combined(std::optional<float> in_a, std::optional<float> in_b) const {
    if (!in_a || !in_b) return in_a ? *in_a : *in_b;
    if (!a_.hasOccupancy()) return *in_b;
    if (!b_.hasOccupancy()) return *in_a;
    return std::clamp(*in_a + *in_b, -kMaxOccupancy, kMaxOccupancy);
  }

  /// Returns the group of the parent of a finest Gaussian, see groupOf(); 0 in a map of one scale.
  std::uint32_t parentGroup(bool in_b, std::size_t index) const {
    return a_.scales() > 1 ? groupOf(in_b, (in_b ? b_ : a_).parentOf(index, 0), 1) : 0;
  }

  MapScale<D> addMoments(std::vector<std::uint32_t>& group) const {
    MapScaleBuilder<D> finest;
    finest.reserveMoments(pairs(0).size());
    for (const CellPair& pair : pairs(0)) {
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
      const bool is_more_b =
          pair.b && (!pair.a || b_.scale(0).moments[*pair.b].count > a_.scale(0).moments[*pair.a].count);
      group.push_back(parentGroup(is_more_b, is_more_b ? *pair.b : *pair.a));
      if (!knowsOccupancy()) continue;
      const auto logOdds = [](const GaussianMap<D>& map, const std::optional<std::size_t>& cell) {
        return cell ? std::optional<float>(map.logOdds(*cell, 0)) : std::nullopt;
      };
      finest.addLogOdds(combined(logOdds(a_, pair.a), logOdds(b_, pair.b)));
    }
    return finest.take();
  }

  /// Returns the Gaussians that both maps have in a finest cell, sorted with before().
  std::vector<Source<D>> sourcesIn(const CellPair& pair) const {
    std::vector<Source<D>> sources;
    const auto add = [&](const GaussianMap<D>& map, std::size_t cell, bool in_b) {
      const IndexRange range = map.gaussiansOf(cell, 0);
      for (std::size_t i = range.first; i < range.last; ++i)
        sources.push_back({map.localGaussian(i, 0), map.logOdds(i, 0), in_b, parentGroup(in_b, i)});
    };
    add(a_, *pair.a, false);
    add(b_, *pair.b, true);
    std::sort(sources.begin(), sources.end(), before<D>);
    return sources;
  }

  /// Agglomerates Gaussians until `parts` clusters are left. Returns the cluster of each Gaussian.
  std::vector<int> closestTogether(const std::vector<Source<D>>& sources, std::size_t parts) const {
    if (parts == 1) return std::vector<int>(sources.size(), 0);
    std::vector<Gaussian<D>> data;
    data.reserve(sources.size());
    for (const Source<D>& source : sources) data.push_back(source.gaussian);
    const std::vector<double> areas(data.size(), 1.0);
    addClusteringNoise(data, a_.grid().side(0));
    AgglomerateOptions agglomeration;
    agglomeration.cost = options_.merge_cost;
    return labels(agglomerate<D>(data, areas, agglomeration), parts);
  }

  static std::vector<Gaussian<D>> matchesOf(const std::vector<Source<D>>& sources, const std::vector<int>& label,
                                            std::size_t parts) {
    std::vector<std::vector<Gaussian<D>>> members(parts);
    for (std::size_t i = 0; i < sources.size(); ++i)
      members[static_cast<std::size_t>(label[i])].push_back(sources[i].gaussian);
    std::vector<Gaussian<D>> matches;
    matches.reserve(parts);
    for (const std::vector<Gaussian<D>>& part : members) matches.push_back(merge(part));
    return matches;
  }

  std::size_t countIn(const CellPair& pair, int s) const {
    return std::max(pair.a ? a_.gaussiansOf(*pair.a, s).size() : 0, pair.b ? b_.gaussiansOf(*pair.b, s).size() : 0);
  }

  MapScale<D> mergeGaussians(std::vector<std::uint32_t>& group) const {
    MapScaleBuilder<D> finest;
    finest.reserveGaussians(pairs(0).size(), pairs(0).size());
    const auto copy = [&](const GaussianMap<D>& map, std::size_t cell, bool in_b) {
      const IndexRange range = map.gaussiansOf(cell, 0);
      for (std::size_t i = range.first; i < range.last; ++i) {
        group.push_back(parentGroup(in_b, i));
        finest.addGaussian(map.localGaussian(i, 0));
        if (knowsOccupancy()) finest.addLogOdds(map.logOdds(i, 0));
      }
    };
    for (const CellPair& pair : pairs(0)) {
      finest.addCell(keyOf(pair, 0));
      if (pair.a && pair.b)
        mergeCell(pair, finest, group);
      else
        pair.a ? copy(a_, *pair.a, false) : copy(b_, *pair.b, true);
    }
    return finest.take();
  }

  /// Merges the Gaussians of a finest cell that both maps have.
  void mergeCell(const CellPair& pair, MapScaleBuilder<D>& finest, std::vector<std::uint32_t>& group) const {
    const std::vector<Source<D>> sources = sourcesIn(pair);
    const std::size_t parts = countIn(pair, 0);
    const std::vector<int> label = closestTogether(sources, parts);
    const std::vector<Gaussian<D>> matches = matchesOf(sources, label, parts);
    for (const Gaussian<D>& match : matches) finest.addGaussian(match);
    for (int part = 0; part < static_cast<int>(parts); ++part) {
      std::optional<float> in_a, in_b;
      const Source<D>* heaviest = nullptr;
      for (std::size_t i = 0; i < sources.size(); ++i) {
        if (label[i] != part) continue;
        if (heaviest == nullptr || sources[i].gaussian.weight > heaviest->gaussian.weight) heaviest = &sources[i];
        std::optional<float>& highest = sources[i].in_b ? in_b : in_a;
        highest = highest ? std::max(*highest, sources[i].log_odds) : sources[i].log_odds;
      }
      group.push_back(heaviest->group);
      if (knowsOccupancy()) finest.addLogOdds(combined(in_a, in_b));
    }
  }

  /// Numbers the clusters of scale s: first those of map a, then those of map b. These numbers are called groups.
  std::uint32_t groupOf(bool in_b, std::size_t cluster, int s) const {
    return static_cast<std::uint32_t>(cluster + (in_b ? a_.gaussianCount(s) : 0));
  }

  /// Makes every finer Gaussian under a cell of both maps a group of its own. The old clusters are too coarse to start
  /// from, because each represents one map only: samples of the coarsest scale would be 12 % farther from the points
  /// (measured with two halves of a drive). Used above scale 1, where there are few finer Gaussians.
  void startAnew(const MapScale<D>& finer, const std::vector<char>& keep, int s,
                 std::vector<std::uint32_t>& group) const {
    auto next = static_cast<std::uint32_t>(a_.gaussianCount(s) + b_.gaussianCount(s));
    std::size_t cell = 0;  // index at scale s
    for (std::size_t child = 0; child < finer.keys.size(); ++child) {
      const auto& key = finer.keys[child];
      while (a_.grid().ancestor(key, s - 1, s) != keyOf(pairs(s)[cell], s)) ++cell;
      if (keep[cell]) continue;
      const IndexRange range = gaussiansOf(finer, child);
      for (std::size_t i = range.first; i < range.last; ++i) group[i] = next++;
    }
  }

  /// Makes coarse scale s. `group` = per finer Gaussian: its old cluster at scale s; `areas` = areas of the finer
  /// Gaussians. On return, `group` = per Gaussian of scale s: its old cluster at scale s + 1; `areas` = their areas.
  MapScale<D> coarseScale(MapScale<D>& finer, int s, std::vector<std::uint32_t>& group,
                          std::vector<double>& areas) const {
    std::size_t extra = 0;
    std::vector<char> keep;
    for (const CellPair& pair : pairs(s)) {
      keep.push_back(!pair.a || !pair.b);
      if (pair.a && pair.b) extra += countIn(pair, s) - 1;
    }
    if (s > 1) startAnew(finer, keep, s, group);
    const ReclusterInput<D> from{finer, a_.grid(), s, group, areas, options_.threads};
    ReclusterResult<D> made = recluster<D>(from, [&](const MapScale<D>& scale, const std::vector<double>& own_areas) {
      if (!is_refined_) return onePerCell<D>(scale);
      return ScaleClusters::within(scale, a_.grid(), s, own_areas, options_.merge_cost, options_.threads, keep)
          .cut(extra);
    });
    group.clear();
    if (s + 1 < a_.scales()) {
      for (const std::uint32_t old : made.group) {
        if (old >= a_.gaussianCount(s) + b_.gaussianCount(s)) {  // made by startAnew(), which replaces this 0 later
          group.push_back(0);
          continue;
        }
        const bool in_b = old >= a_.gaussianCount(s);
        const GaussianMap<D>& map = in_b ? b_ : a_;
        group.push_back(groupOf(in_b, map.parentOf(old - (in_b ? a_.gaussianCount(s) : 0), s), s + 1));
      }
    }
    areas = std::move(made.areas);
    return std::move(made.scale);
  }

  const GaussianMap<D>&a_, &b_;
  const MergeMapsOptions options_;
  const bool exact_, is_refined_;
  const std::vector<std::vector<CellPair>> pairs_;  // per scale
};

void requireEqual(const char* option, double a, double b) {
  if (a == b) return;
  std::ostringstream text;
  text << option << " " << a << " and " << b
       << ": maps of different grids have no common cells; resample one of them into the grid of the other";
  throw std::invalid_argument(text.str());
}

}  // namespace

template <int D>
GaussianMap<D> mergeMaps(const GaussianMap<D>& a, const GaussianMap<D>& b, const MergeMapsOptions& options) {
  requireEqual("resolutions", a.options().resolution, b.options().resolution);
  requireEqual("ratios", a.options().ratio, b.options().ratio);
  requireEqual("numbers of scales", a.scales(), b.scales());
  requireEqual("noise floors", a.options().noise, b.options().noise);
  if (a.isCompressed() || b.isCompressed())
    throw std::invalid_argument(
        "a compressed map has no finest Gaussians in some cells, so it cannot be merged: merge the maps that it was "
        "made from, then compress");
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  return MapMerger<D>(a, b, options).run();
}

template GaussianMap<2> mergeMaps<2>(const GaussianMap<2>&, const GaussianMap<2>&, const MergeMapsOptions&);
template GaussianMap<3> mergeMaps<3>(const GaussianMap<3>&, const GaussianMap<3>&, const MergeMapsOptions&);

}  // namespace gaussmap
