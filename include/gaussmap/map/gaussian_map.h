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

/// Highest log-odds of occupancy, the paper's o_max. A map built in one go has seen no miss: all its clusters have it.
inline constexpr float kMaxOccupancy = 10.0f;

/// Indices first, first + 1, ..., last - 1.
struct IndexRange {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t size() const { return last - first; }
  bool empty() const { return first == last; }
};

/// One scale as plain arrays. Cells stand in key order: sorted by their ancestor at the coarsest scale, then by
/// the next finer one, and so on, each as x, then y, then z. The children of a cell are therefore neighbours.
template <int D>
struct MapScale {
  std::vector<CellKey<D>> keys;               ///< n cells
  std::vector<std::uint32_t> first_child;     ///< n + 1 indices of cells of the finer scale; empty at the finest
  std::vector<CellMoments<D>> moments;        ///< n, or empty: finest scale only, what its Gaussians are made from
  std::vector<std::uint32_t> first_gaussian;  ///< n + 1, or empty: cell i holds Gaussian i
  std::vector<Gaussian<D>> gaussians;         ///< mean about the centre of the cell; empty where there are moments
  std::vector<std::uint32_t> parent;          ///< per Gaussian, its cluster at the coarser scale; empty at the coarsest
  std::vector<float> log_odds;                ///< per Gaussian, of being occupied; or empty: no scan was asked

  std::size_t gaussianCount() const { return gaussians.empty() ? moments.size() : gaussians.size(); }
};

/// A multi-scale map: at every scale a sparse grid of cells with Gaussians in them, one per cell at the finest
/// scale, one or more at the coarser ones, linked to the finer Gaussians that they stand for (Yguel 2009, sec. 3, 5).
/// A coarse cell may stand alone, without cells under it: compress() deletes detail where it is not needed.
/// A value: made by build(), improved by refine(), kept by save(). Reading from several threads is safe.
template <int D>
class GAUSSMAP_API GaussianMap {
 public:
  /// An empty map. Throws std::invalid_argument on unusable options.
  explicit GaussianMap(const MapOptions& options = {})
      : grid_(options), scales_(std::size_t(grid_.scales())), weights_(scales_.size(), 0.0) {}

  /// From finished scales, finest first. Throws std::invalid_argument, saying what, if they do not fit together.
  GaussianMap(const MapOptions& options, std::vector<MapScale<D>> scales);

  /// Moves all scales out, finest first: std::move(map).takeScales(). The map is empty afterwards.
  std::vector<MapScale<D>> takeScales() &&;

  const Grid<D>& grid() const { return grid_; }
  const MapOptions& options() const { return grid_.options(); }
  int scales() const { return grid_.scales(); }
  const MapScale<D>& scale(int s) const { return scales_[static_cast<std::size_t>(s)]; }
  bool empty() const { return scales_.back().keys.empty(); }
  /// True when some coarse cell has no cells under it: the finer scales do not cover the whole map.
  bool isCompressed() const { return compressed_; }
  /// True if the finest scale holds the exact moments of all points: such a map accepts more scans and merges exactly.
  /// All other maps are final.
  bool acceptsScans() const { return empty() || (!isCompressed() && !scales_.front().moments.empty()); }

  std::size_t cellCount(int s) const { return scale(s).keys.size(); }
  std::size_t gaussianCount(int s) const { return scale(s).gaussianCount(); }
  /// Sum of the weights of a scale: the number of points under its cells. The same at every scale, unless the map is
  /// compressed: then it is less where cells are missing, and that of all points at the coarsest scale only.
  double weight(int s) const { return weights_[static_cast<std::size_t>(s)]; }

  /// Index of a cell, or nothing if it is not occupied. Logarithmic in the children of a cell.
  std::optional<std::size_t> find(const CellKey<D>& key, int s) const;
  /// The Gaussians of cell `cell` of scale s.
  IndexRange gaussiansOf(std::size_t cell, int s) const;
  /// The cell that Gaussian `index` of scale s lies in.
  std::size_t cellOf(std::size_t index, int s) const;
  /// The cells of scale s - 1 under a cell of scale s >= 1; an empty range if there are none.
  IndexRange childCells(std::size_t cell, int s) const;
  /// True if the map has nothing finer than this cell: at the finest scale, and where a compressed map ends above it.
  bool isLeaf(std::size_t cell, int s) const { return s == 0 || childCells(cell, s).empty(); }
  /// All Gaussians of scale s - 1 in the cells under a cell of scale s >= 1: G(phi(c)) of the paper.
  IndexRange gaussiansUnder(std::size_t cell, int s) const;

  /// Gaussian `index` of scale s, map frame.
  Gaussian<D> gaussian(std::size_t index, int s) const;
  /// The same with its mean about the centre of its cell: nothing lost far from the origin.
  Gaussian<D> localGaussian(std::size_t index, int s) const;

  /// True when range images have been asked about the Gaussians: a map made on line. All scales know it, or none.
  bool hasOccupancy() const { return !scale(scales() - 1).log_odds.empty(); }
  /// Log-odds that something is there; kMaxOccupancy in a map that has seen no miss since no scan was asked.
  float logOdds(std::size_t index, int s) const { return hasOccupancy() ? scale(s).log_odds[index] : kMaxOccupancy; }

  /// The cluster of scale s + 1 that a Gaussian of scale s belongs to (paper Fig. 6); s below the coarsest.
  std::size_t parentOf(std::size_t index, int s) const { return scale(s).parent[index]; }
  /// The Gaussians of scale s - 1 that a cluster of scale s >= 1 stands for.
  std::vector<std::size_t> childrenOf(std::size_t index, int s) const;

 private:
  Grid<D> grid_;
  std::vector<MapScale<D>> scales_;  // finest first
  std::vector<double> weights_;      // of each scale
  bool compressed_ = false;
};

using GaussianMapOctree = GaussianMap<3>;
using GaussianMapQuadtree = GaussianMap<2>;

/// The permutation that puts cells of one scale into key order; `levels` = how many coarser scales there are.
template <int D>
GAUSSMAP_API std::vector<std::uint32_t> keyOrder(const std::vector<CellKey<D>>& keys, int ratio, int levels);

}  // namespace gaussmap
