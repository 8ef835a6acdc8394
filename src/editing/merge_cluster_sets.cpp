// SPDX-License-Identifier: BSD-3-Clause
#include "editing/merge_cluster_sets.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "map/map_scale_builder.h"
#include "map/occupied_areas.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint32_t kDropped = 0xFFFFFFFFu;  // of a Gaussian below a cell that is a leaf of the other map

/// The Gaussians of both maps in a cell that both have, and their new clusters.
template <int D>
struct UnitedCell {
  std::vector<SourceGaussian<D>> sources;
  std::vector<int> label;
};

/// A scale of the merged map, and the new cluster of every Gaussian of each map.
template <int D>
struct UnitedScale {
  MapScale<D> scale;
  std::vector<std::uint32_t> new_of_a, new_of_b;
};

/// Returns the number of occupied finest cells per Gaussian, for every scale of a map.
template <int D>
std::vector<std::vector<double>> areasOfScales(const GaussianMap<D>& map) {
  std::vector<std::vector<double>> areas = {finestAreas(map.scale(0))};
  for (int s = 1; s < map.scales(); ++s)
    areas.push_back(areasOf<D>(map.scale(s), map.grid(), s, map.scale(s - 1), areas.back()));
  return areas;
}

template <int D>
class ClusterSetMerger {
 public:
  ClusterSetMerger(const MapPair<D>& maps, const MergeMapsOptions& options)
      : maps_(maps), options_(options), exact_(hasMoments(maps.a()) && hasMoments(maps.b())) {
    if (options.merge_cost != MergeCost::Volume) return;  // the other costs do not use areas
    areas_a_ = areasOfScales(maps.a());
    areas_b_ = areasOfScales(maps.b());
  }

  GaussianMap<D> run() const {
    std::vector<UnitedScale<D>> united;
    for (int s = 0; s < maps_.scales(); ++s) united.push_back(s == 0 && exact_ ? finestOfMoments() : unitedScale(s));
    std::vector<MapScale<D>> scales;
    for (std::size_t s = 0; s < united.size(); ++s) {
      if (s + 1 < united.size()) link(static_cast<int>(s), united[s], united[s + 1]);
      scales.push_back(std::move(united[s].scale));
    }
    return GaussianMap<D>(maps_.grid().options(), std::move(scales));
  }

 private:
  static bool hasMoments(const GaussianMap<D>& map) { return map.cellCount(0) == 0 || !map.scale(0).moments.empty(); }

  UnitedScale<D> emptyScale(int s) const {
    return {{},
            std::vector<std::uint32_t>(maps_.a().gaussianCount(s), kDropped),
            std::vector<std::uint32_t>(maps_.b().gaussianCount(s), kDropped)};
  }

  UnitedScale<D> finestOfMoments() const {
    UnitedScale<D> made = emptyScale(0);
    made.scale = maps_.addMoments();
    for (std::size_t cell = 0; cell < maps_.cells(0).size(); ++cell) {  // one Gaussian per cell
      const CellPair& pair = maps_.cells(0)[cell];
      if (pair.a) made.new_of_a[*pair.a] = static_cast<std::uint32_t>(cell);
      if (pair.b) made.new_of_b[*pair.b] = static_cast<std::uint32_t>(cell);
    }
    return made;
  }

  /// Returns the Gaussians of a cell. If both maps have the cell, they are divided into clusters.
  UnitedCell<D> unite(const CellPair& pair, int s) const {
    UnitedCell<D> cell{maps_.sourcesIn(pair, s), {}};
    std::vector<double> areas;
    for (const SourceGaussian<D>& source : cell.sources)
      areas.push_back(
          areas_a_.empty() ? 1.0 : (source.in_b ? areas_b_ : areas_a_)[static_cast<std::size_t>(s)][source.index]);
    cell.label = unitedLabels<D>(cell.sources, areas, maps_.countIn(pair, s), maps_.grid().side(0), options_);
    return cell;
  }

  UnitedScale<D> unitedScale(int s) const {
    const std::vector<CellPair>& cells = maps_.cells(s);
    std::vector<UnitedCell<D>> shared(cells.size());
    parallelFor(cells.size(), options_.threads, 16, [&](std::size_t cell) {
      if (cells[cell].a && cells[cell].b) shared[cell] = unite(cells[cell], s);
    });
    UnitedScale<D> made = emptyScale(s);
    MapScaleBuilder<D> builder;
    const auto copy = [&](const GaussianMap<D>& map, std::size_t cell, std::vector<std::uint32_t>& new_of) {
      const IndexRange range = map.gaussiansOf(cell, s);
      for (std::size_t i = range.first; i < range.last; ++i) {
        new_of[i] = static_cast<std::uint32_t>(builder.gaussians());
        builder.addGaussian(map.localGaussian(i, s));
        if (maps_.hasOccupancy()) builder.addLogOdds(map.logOdds(i, s));
      }
    };
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      builder.addCell(maps_.keyOf(cells[cell], s));
      if (s > 0) builder.addFirstChild(maps_.firstChild(s)[cell]);
      if (cells[cell].a && cells[cell].b)
        add(shared[cell], builder, made);
      else
        cells[cell].a ? copy(maps_.a(), *cells[cell].a, made.new_of_a) : copy(maps_.b(), *cells[cell].b, made.new_of_b);
    }
    made.scale = s > 0 ? builder.take(maps_.cells(s - 1).size()) : builder.take();
    return made;
  }

  void add(const UnitedCell<D>& cell, MapScaleBuilder<D>& builder, UnitedScale<D>& made) const {
    const auto first = static_cast<std::uint32_t>(builder.gaussians());
    for (std::size_t i = 0; i < cell.sources.size(); ++i) {
      const SourceGaussian<D>& source = cell.sources[i];
      (source.in_b ? made.new_of_b : made.new_of_a)[source.index] = first + static_cast<std::uint32_t>(cell.label[i]);
    }
    int part = 0;
    for (const Gaussian<D>& match : unionsOf<D>(cell.sources, cell.label)) {
      builder.addGaussian(match);
      if (maps_.hasOccupancy()) builder.addLogOdds(maps_.combined(cell.sources, cell.label, part));
      ++part;
    }
  }

  /// Links the clusters of scale s to those of the next coarser scale. The parents of the old members have become parts
  /// of new clusters. A cluster is linked to the new cluster with the largest part of its weight, to the first of equal
  /// ones. Coarse clusters do not change, so one of them can lose children, or all, to another one.
  void link(int s, UnitedScale<D>& finer, const UnitedScale<D>& coarser) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> weights;  // by cluster and parent
    const auto add = [&](const GaussianMap<D>& map, const std::vector<std::uint32_t>& new_of,
                         const std::vector<std::uint32_t>& new_parents) {
      for (std::size_t i = 0; i < new_of.size(); ++i)
        if (new_of[i] != kDropped)
          weights[{new_of[i], new_parents[map.parentOf(i, s)]}] += map.localGaussian(i, s).weight;
    };
    add(maps_.a(), finer.new_of_a, coarser.new_of_a);
    add(maps_.b(), finer.new_of_b, coarser.new_of_b);
    std::vector<double> heaviest(finer.scale.gaussianCount(), 0.0);
    finer.scale.parent.resize(heaviest.size());
    for (const auto& [link, weight] : weights) {
      if (!(weight > heaviest[link.first])) continue;
      heaviest[link.first] = weight;
      finer.scale.parent[link.first] = link.second;
    }
  }

  const MapPair<D>& maps_;
  const MergeMapsOptions options_;
  const bool exact_;
  std::vector<std::vector<double>> areas_a_, areas_b_;  // per scale and Gaussian; empty if the cost does not use areas
};

template <int D>
std::vector<Gaussian<D>> gaussiansOfSources(const std::vector<SourceGaussian<D>>& sources) {
  std::vector<Gaussian<D>> data;
  data.reserve(sources.size());
  for (const SourceGaussian<D>& source : sources) data.push_back(source.gaussian);
  return data;
}

}  // namespace

template <int D>
std::vector<int> unitedLabels(const std::vector<SourceGaussian<D>>& sources, const std::vector<double>& areas,
                              std::size_t parts, double finest_side, const MergeMapsOptions& options) {
  if (parts == 1) return std::vector<int>(sources.size(), 0);
  const std::vector<Gaussian<D>> data = gaussiansOfSources<D>(sources);
  const std::vector<int> label = labels(agglomerateCell<D>(data, areas, finest_side, options.merge_cost), parts);
  return options.smooth ? smoothedLabels<D>(data, label, parts) : label;
}

template <int D>
std::vector<Gaussian<D>> unionsOf(const std::vector<SourceGaussian<D>>& sources, const std::vector<int>& label) {
  const int last = *std::max_element(label.begin(), label.end());
  return clustersOf<D>(gaussiansOfSources<D>(sources), label, static_cast<std::size_t>(last) + 1);
}

template <int D>
GaussianMap<D> mergeClusterSets(const MapPair<D>& maps, const MergeMapsOptions& options) {
  return ClusterSetMerger<D>(maps, options).run();
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                  \
  template std::vector<int> unitedLabels<D>(const std::vector<SourceGaussian<D>>&, const std::vector<double>&,   \
                                            std::size_t, double, const MergeMapsOptions&);                       \
  template std::vector<Gaussian<D>> unionsOf<D>(const std::vector<SourceGaussian<D>>&, const std::vector<int>&); \
  template GaussianMap<D> mergeClusterSets<D>(const MapPair<D>&, const MergeMapsOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
