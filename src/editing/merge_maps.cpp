// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/merge_maps.h"

#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "editing/map_pair.h"
#include "editing/merge_cluster_sets.h"
#include "editing/recluster.h"
#include "map/map_scale_builder.h"
#include "map/occupied_areas.h"

namespace gaussmap {
using namespace detail;

namespace {

template <int D>
class MapMerger {
 public:
  MapMerger(const MapPair<D>& maps, const MergeMapsOptions& options)
      : maps_(maps),
        a_(maps.a()),
        b_(maps.b()),
        options_(options),
        exact_(a_.acceptsScans() && b_.acceptsScans()),
        is_refined_(isRefined(a_) || isRefined(b_)) {}

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
  /// Returns the group of the parent of a finest Gaussian, see groupOf(); 0 in a map of one scale.
  std::uint32_t parentGroup(bool in_b, std::size_t index) const {
    return a_.scales() > 1 ? groupOf(in_b, (in_b ? b_ : a_).parentOf(index, 0), 1) : 0;
  }

  MapScale<D> addMoments(std::vector<std::uint32_t>& group) const {
    for (const CellPair& pair : maps_.cells(0)) {
      const bool is_more_b =
          pair.b && (!pair.a || b_.scale(0).moments[*pair.b].count > a_.scale(0).moments[*pair.a].count);
      group.push_back(parentGroup(is_more_b, is_more_b ? *pair.b : *pair.a));
    }
    return maps_.addMoments();
  }

  MapScale<D> mergeGaussians(std::vector<std::uint32_t>& group) const {
    MapScaleBuilder<D> finest;
    finest.reserveGaussians(maps_.cells(0).size(), maps_.cells(0).size());
    const auto copy = [&](const GaussianMap<D>& map, std::size_t cell, bool in_b) {
      const IndexRange range = map.gaussiansOf(cell, 0);
      for (std::size_t i = range.first; i < range.last; ++i) {
        group.push_back(parentGroup(in_b, i));
        finest.addGaussian(map.localGaussian(i, 0));
        if (maps_.hasOccupancy()) finest.addLogOdds(map.logOdds(i, 0));
      }
    };
    for (const CellPair& pair : maps_.cells(0)) {
      finest.addCell(maps_.keyOf(pair, 0));
      if (pair.a && pair.b)
        mergeCell(pair, finest, group);
      else
        pair.a ? copy(a_, *pair.a, false) : copy(b_, *pair.b, true);
    }
    return finest.take();
  }

  /// Merges the Gaussians of a finest cell that both maps have.
  void mergeCell(const CellPair& pair, MapScaleBuilder<D>& finest, std::vector<std::uint32_t>& group) const {
    const std::vector<SourceGaussian<D>> sources = maps_.sourcesIn(pair, 0);
    const std::vector<double> areas(sources.size(), 1.0);
    const std::vector<int> label = unitedLabels<D>(sources, areas, maps_.countIn(pair, 0), a_.grid().side(0), options_);
    int part = 0;
    for (const Gaussian<D>& match : unionsOf<D>(sources, label)) {
      const SourceGaussian<D>* heaviest = nullptr;
      for (std::size_t i = 0; i < sources.size(); ++i)
        if (label[i] == part && (heaviest == nullptr || sources[i].gaussian.weight > heaviest->gaussian.weight))
          heaviest = &sources[i];
      finest.addGaussian(match);
      group.push_back(parentGroup(heaviest->in_b, heaviest->index));
      if (maps_.hasOccupancy()) finest.addLogOdds(maps_.combined(sources, label, part));
      ++part;
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
      while (a_.grid().ancestor(key, s - 1, s) != maps_.keyOf(maps_.cells(s)[cell], s)) ++cell;
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
    for (const CellPair& pair : maps_.cells(s)) {
      keep.push_back(!pair.a || !pair.b);
      if (pair.a && pair.b) extra += maps_.countIn(pair, s) - 1;
    }
    if (s > 1) startAnew(finer, keep, s, group);
    const ReclusterInput<D> from{finer, a_.grid(), s, group, areas, options_.threads};
    ReclusterResult<D> made = recluster<D>(from, [&](const MapScale<D>& scale, const std::vector<double>& own_areas) {
      if (!is_refined_) return onePerCell<D>(scale);
      const ClusterCut cut =
          ScaleClusters::within(scale, a_.grid(), s, own_areas, options_.merge_cost, options_.threads, keep).cut(extra);
      return options_.smooth ? smoothed<D>(scale, a_.grid(), s, cut, options_.threads) : cut;
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

  const MapPair<D>& maps_;
  const GaussianMap<D>&a_, &b_;
  const MergeMapsOptions options_;
  const bool exact_, is_refined_;
};

void requireEqual(const char* option, double a, double b) {
  if (a == b) return;
  std::ostringstream text;
  text << option << " " << a << " and " << b
       << ": maps of different grids have no common cells; resample one of them into the grid of the other";
  throw std::invalid_argument(text.str());
}

}  // namespace

MergeMapsOptions MergeMapsOptions::yguel2009() {
  MergeMapsOptions options;
  options.method = MergeMethod::Clusters;
  options.merge_cost = MergeCost::KL;
  options.smooth = true;
  return options;
}

template <int D>
GaussianMap<D> mergeMaps(const GaussianMap<D>& a, const GaussianMap<D>& b, const MergeMapsOptions& options) {
  requireEqual("resolutions", a.options().resolution, b.options().resolution);
  requireEqual("ratios", a.options().ratio, b.options().ratio);
  requireEqual("numbers of scales", a.scales(), b.scales());
  requireEqual("noise floors", a.options().noise, b.options().noise);
  if (options.method == MergeMethod::FinerScales && (a.isCompressed() || b.isCompressed()))
    throw std::invalid_argument(
        "a compressed map has no finest Gaussians in some cells, so it cannot be merged: merge the maps that it was "
        "made from, then compress; or use MergeMethod::Clusters (gaussmap merge --method clusters)");
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  const MapPair<D> maps(a, b);
  return options.method == MergeMethod::Clusters ? mergeClusterSets<D>(maps, options)
                                                 : MapMerger<D>(maps, options).run();
}

template GaussianMap<2> mergeMaps<2>(const GaussianMap<2>&, const GaussianMap<2>&, const MergeMapsOptions&);
template GaussianMap<3> mergeMaps<3>(const GaussianMap<3>&, const GaussianMap<3>&, const MergeMapsOptions&);

}  // namespace gaussmap
