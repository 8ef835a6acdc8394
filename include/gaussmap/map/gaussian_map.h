// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Maximum log-odds of occupancy, the paper's o_max. In a map without occupancy, all clusters have this value, because
/// it is not known that any beam passed through them.
inline constexpr float kMaxOccupancy = 10.0f;

/// A range of indices: first, first + 1, ..., last - 1.
struct IndexRange {
  std::size_t first = 0;                             ///< first index
  std::size_t last = 0;                              ///< one past the last index
  std::size_t size() const { return last - first; }  ///< number of indices
  bool empty() const { return first == last; }       ///< true if the range holds no index
};

/// One scale of a map as plain arrays.
///
/// Cells are in key order: sorted by their ancestor at the coarsest scale, then by the ancestor at the next finer
/// scale, and so on, each by x, then y, then z. The children of a cell are therefore consecutive.
template <int D>
struct MapScale {
  std::vector<CellKey<D>> keys;  ///< n cells
  /// n + 1 indices: the children of cell i are cells first_child[i] to first_child[i + 1] - 1 of the finer scale. The
  /// array is empty at scale 0.
  std::vector<std::uint32_t> first_child;
  /// n exact moments, or empty. Only scale 0 can have moments. Its Gaussians are then computed from them.
  std::vector<CellMoments<D>> moments;
  /// n + 1 indices: cell i holds the Gaussians first_gaussian[i] to first_gaussian[i + 1] - 1. If the array is empty,
  /// cell i holds only Gaussian i.
  std::vector<std::uint32_t> first_gaussian;
  std::vector<Gaussian<D>> gaussians;  ///< means relative to the cell's centre; empty if there are moments
  std::vector<std::uint32_t> parent;   ///< per Gaussian: its cluster of the coarser scale; empty at the coarsest
  std::vector<float> log_odds;         ///< per Gaussian: occupancy; empty if the map has no occupancy

  /// Returns the number of Gaussians.
  std::size_t gaussianCount() const { return gaussians.empty() ? moments.size() : gaussians.size(); }
};

/// A multi-scale map of Gaussians, Yguel 2009 sec. 3 and 5.
///
/// Every scale is a sparse grid of cells that hold Gaussians. build() makes one Gaussian per cell at the finest scale.
/// A coarser cell holds one or more Gaussians (clusters), which are linked to the finer Gaussians that they represent.
/// A coarse cell can be a leaf, without cells below it: compress() deletes detail that is not needed.
///
/// A map is a plain value. build() makes it, refine() improves it, save() stores it. Several threads can read it at the
/// same time.
template <int D>
class GAUSSMAP_API GaussianMap {
 public:
  /// Makes an empty map. Throws std::invalid_argument if the options are not usable (see Grid).
  explicit GaussianMap(const MapOptions& options = {})
      : grid_(options), scales_(std::size_t(grid_.scales())), weights_(scales_.size(), 0.0) {}

  /// Makes a map of finished scales, finest first. Throws std::invalid_argument if the scales are not consistent; the
  /// message gives the reason.
  GaussianMap(const MapOptions& options, std::vector<MapScale<D>> scales);

  /// Moves all scales out, finest first: `std::move(map).takeScales()`. The map is empty afterwards.
  std::vector<MapScale<D>> takeScales() &&;

  /// Returns the grid of cells.
  const Grid<D>& grid() const { return grid_; }
  /// Returns the options, with the automatic noise filled in.
  const MapOptions& options() const { return grid_.options(); }
  /// Returns the number of scales.
  int scales() const { return grid_.scales(); }
  /// Returns the arrays of scale `s`.
  const MapScale<D>& scale(int s) const { return scales_[static_cast<std::size_t>(s)]; }
  /// Returns true if the map has no cell.
  bool empty() const { return scales_.back().keys.empty(); }
  /// Returns true if a coarse cell has no cells below it. The finer scales then do not cover the whole map.
  bool isCompressed() const { return compressed_; }
  /// Returns true if the map can take more points: it is empty, or its finest scale holds the exact moments of all
  /// points. mergeMaps() merges two such maps without loss.
  bool acceptsScans() const { return empty() || (!isCompressed() && !scales_.front().moments.empty()); }

  /// Returns the number of cells of scale `s`.
  std::size_t cellCount(int s) const { return scale(s).keys.size(); }
  /// Returns the number of Gaussians of scale `s`.
  std::size_t gaussianCount(int s) const { return scale(s).gaussianCount(); }
  /// Returns the sum of the weights of scale `s`: the number of points that its Gaussians represent. In a compressed
  /// map only the coarsest scale represents all points. In any other map all scales have the same sum.
  double weight(int s) const { return weights_[static_cast<std::size_t>(s)]; }

  /// Returns the index of a cell of scale `s`, or std::nullopt if the cell is not occupied. The search goes from the
  /// coarsest scale down to scale `s`. Per scale it is a binary search, first in all coarsest cells, then in the
  /// children of one cell.
  std::optional<std::size_t> find(const CellKey<D>& key, int s) const;
  /// Returns the Gaussians of cell `cell` of scale `s`.
  IndexRange gaussiansOf(std::size_t cell, int s) const;
  /// Returns the cell that holds Gaussian `index` of scale `s`.
  std::size_t cellOf(std::size_t index, int s) const;
  /// Returns the cells of scale `s` - 1 below a cell of scale `s` >= 1. The range is empty if there are none.
  IndexRange childCells(std::size_t cell, int s) const;
  /// Returns true if the map has no cells below this cell. This holds for all cells of scale 0 and for some coarse
  /// cells of a compressed map.
  bool isLeaf(std::size_t cell, int s) const { return s == 0 || childCells(cell, s).empty(); }
  /// Returns all Gaussians of scale `s` - 1 in the cells below a cell of scale `s` >= 1: G(phi(c)) of the paper.
  IndexRange gaussiansUnder(std::size_t cell, int s) const;

  /// Returns Gaussian `index` of scale `s`, map frame.
  Gaussian<D> gaussian(std::size_t index, int s) const;
  /// Returns Gaussian `index` of scale `s` with its mean relative to the centre of its cell [m]. This mean is exact
  /// also far from the origin.
  Gaussian<D> localGaussian(std::size_t index, int s) const;

  /// Returns true if the Gaussians have occupancy values from range images, as in a map of OnlineMapper. Either all
  /// scales have them or none.
  bool hasOccupancy() const { return !scale(scales() - 1).log_odds.empty(); }
  /// Returns the log-odds that the surface at Gaussian `index` of scale `s` still exists, or kMaxOccupancy if the map
  /// has no occupancy.
  float logOdds(std::size_t index, int s) const { return hasOccupancy() ? scale(s).log_odds[index] : kMaxOccupancy; }

  /// Returns the parent of Gaussian `index` of scale `s`: a cluster of scale `s` + 1 (paper, Fig. 6). `s` must be below
  /// the coarsest scale.
  std::size_t parentOf(std::size_t index, int s) const { return scale(s).parent[index]; }
  /// Returns the children of Gaussian `index` of scale `s` >= 1: the Gaussians of scale `s` - 1 that it represents.
  std::vector<std::size_t> childrenOf(std::size_t index, int s) const;

 private:
  Grid<D> grid_;
  std::vector<MapScale<D>> scales_;  // finest first
  std::vector<double> weights_;      // per scale
  bool compressed_ = false;
};

/// A map in space.
using GaussianMapOctree = GaussianMap<3>;
/// A planar map. It lies in the plane z = 0 of the map frame: points lose their z coordinate when they are added.
/// Functions that show, write or compare Gaussians in space use z = 0.
using GaussianMapQuadtree = GaussianMap<2>;

/// Returns the permutation that puts the cells of one scale into key order (see MapScale). `levels` is the number of
/// scales of the map that are coarser than this one.
template <int D>
GAUSSMAP_API std::vector<std::uint32_t> keyOrder(const std::vector<CellKey<D>>& keys, int ratio, int levels);

}  // namespace gaussmap
