// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"
#include "gaussmap/mapping/refine.h"
#include "map/coarsen.h"

namespace gaussmap::detail {

/// The clusters of a refined cell and which of them each finer Gaussian under it belongs to.
template <int D>
struct CellClusters {
  std::vector<Gaussian<D>> references;  // empty: still the one Gaussian of coarsen()
  std::vector<int> labels;
};

/// What refining makes of a coarse scale.
template <int D>
struct ScaleCut {
  std::vector<std::uint32_t> first_gaussian;  // as in MapScale
  std::vector<Gaussian<D>> gaussians;
  std::vector<std::uint32_t> parent;  // of each Gaussian of the finer scale
};

/// How many Gaussians a multiple of its cells allows a scale beyond one a cell.
inline std::size_t extraGaussians(double multiple, std::size_t cells, std::size_t finer_gaussians) {
  const double most = std::floor(multiple * static_cast<double>(cells));
  // More than one per finer Gaussian is never used; the bound also keeps the conversion in range.
  const auto all = static_cast<std::size_t>(std::min(most, static_cast<double>(finer_gaussians)));
  return all - std::min(all, cells);
}

/// The same by the options: max_gaussians of this scale if given, else the budget.
/// Throws std::invalid_argument if max_gaussians leaves a cell without a Gaussian.
inline std::size_t extraGaussians(const RefineOptions& options, int scale, std::size_t cells,
                                  std::size_t finer_gaussians) {
  const auto most = options.max_gaussians.find(scale);
  if (most == options.max_gaussians.end()) return extraGaussians(options.budget, cells, finer_gaussians);
  if (most->second < cells)
    throw std::invalid_argument("max_gaussians = " + std::to_string(most->second) + ": scale " + std::to_string(scale) +
                                " has " + std::to_string(cells) +
                                " occupied cells, which hold at least one each; take coarser cells");
  return most->second - cells;
}

/// One coarse scale fresh from coarsen(), about to be refined.
template <int D>
struct CoarseScale {
  MapScale<D>& finer;
  MapScale<D>& coarse;
  const Grid<D>& grid;
  int finer_scale;

  std::size_t cells() const { return coarse.keys.size(); }
  IndexRange children(std::size_t cell) const { return {coarse.first_child[cell], coarse.first_child[cell + 1]}; }
  /// G(phi(c)) as indices of the finer scale.
  IndexRange gaussiansUnder(std::size_t cell) const {
    const IndexRange finer_cells = children(cell);
    return {gaussiansOf(finer, finer_cells.first).first, gaussiansOf(finer, finer_cells.last - 1).last};
  }
  /// G(phi(c)), means about the cell's centre.
  std::vector<Gaussian<D>> dataUnder(std::size_t cell) const {
    std::vector<Gaussian<D>> data;
    gatherUnder(finer, grid, finer_scale, children(cell), data);
    return data;
  }

  /// extraGaussians() of this scale.
  std::size_t extraOf(double multiple) const { return extraGaussians(multiple, cells(), finer.gaussianCount()); }
  std::size_t extraAllowed(const RefineOptions& options) const {
    return extraGaussians(options, finer_scale + 1, cells(), finer.gaussianCount());
  }

  ScaleCut<D> cutInto(const std::vector<CellClusters<D>>& clusters) const {
    ScaleCut<D> cut;
    cut.parent.resize(finer.gaussianCount());
    for (std::size_t cell = 0; cell < clusters.size(); ++cell) {
      const auto first = static_cast<std::uint32_t>(cut.gaussians.size());
      cut.first_gaussian.push_back(first);
      const IndexRange under = gaussiansUnder(cell);
      const auto& [references, labels] = clusters[cell];
      for (std::size_t i = under.first; i < under.last; ++i)
        cut.parent[i] = first + static_cast<std::uint32_t>(labels.empty() ? 0 : labels[i - under.first]);
      if (references.empty())
        cut.gaussians.push_back(coarse.gaussians[cell]);
      else
        cut.gaussians.insert(cut.gaussians.end(), references.begin(), references.end());
    }
    cut.first_gaussian.push_back(static_cast<std::uint32_t>(cut.gaussians.size()));
    return cut;
  }
  /// Replaces the Gaussians of the coarse scale, links the finer ones to them.
  void replaceGaussians(const std::vector<CellClusters<D>>& clusters) {
    ScaleCut<D> cut = cutInto(clusters);
    coarse.first_gaussian = std::move(cut.first_gaussian);
    coarse.gaussians = std::move(cut.gaussians);
    finer.parent = std::move(cut.parent);
  }
};

/// Refines a scale as RefineMethod::Insert says.
template <int D>
void refineByInsertion(CoarseScale<D>& scale, const RefineOptions& options);

/// RefineMethod::Agglomerate: one dendrogram a cell, from which every number of Gaussians can be cut.
template <int D>
class ScaleCuts {
 public:
  /// `areas` = occupied finest cells under each finer Gaussian. The scale must outlive the cuts.
  ScaleCuts(const CoarseScale<D>& scale, const std::vector<double>& areas, const RefineOptions& options);
  /// The same from dendrograms() made before.
  ScaleCuts(const CoarseScale<D>& scale, std::vector<Dendrogram> dendrograms, int threads);

  int scale() const { return scale_.finer_scale + 1; }
  const std::vector<CellKey<D>>& keys() const { return scale_.coarse.keys; }
  std::size_t extraOf(double multiple) const { return scale_.extraOf(multiple); }
  std::size_t extraAllowed(const RefineOptions& options) const { return scale_.extraAllowed(options); }
  /// The Gaussians that the finer scale allows beyond one a cell.
  std::size_t mostExtra() const;
  const std::vector<Dendrogram>& dendrograms() const { return dendrograms_; }
  /// gainsOfUndoing() of every cell.
  const std::vector<std::vector<double>>& gains() const { return gains_; }

  /// The clusters of every cell when `extra` Gaussians are there beyond one a cell.
  std::vector<CellClusters<D>> clusters(std::size_t extra) const;
  /// The clusters when every cell is cut into so many parts.
  std::vector<CellClusters<D>> clusters(const std::vector<std::size_t>& parts) const;
  ScaleCut<D> cut(std::size_t extra) const;

 private:
  const CoarseScale<D>& scale_;
  int threads_;
  std::vector<Dendrogram> dendrograms_;
  std::vector<std::vector<double>> gains_;
};

/// refine() by agglomeration where `choose` says for every coarse scale, from the finest up, how many Gaussians it
/// gets beyond one a cell.
template <int D>
GaussianMap<D> refineByChoice(GaussianMap<D> map, const RefineOptions& options,
                              const std::function<std::size_t(const ScaleCuts<D>&)>& choose);

}  // namespace gaussmap::detail
