// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "map/coarsen.h"

namespace gaussmap::detail {

/// Builds a scale cell by cell and hides which of its columns may be empty: `first_gaussian` is filled only if some
/// cell holds several Gaussians, and columns to which nothing is added stay empty.
///
/// Call addCell(), then add the Gaussians of that cell, then the next cell. Every cell needs at least one Gaussian.
template <int D>
class MapScaleBuilder {
 public:
  void reserveMoments(std::size_t cells) {
    scale_.keys.reserve(cells);
    scale_.moments.reserve(cells);
  }
  void reserveGaussians(std::size_t cells, std::size_t gaussians) {
    scale_.keys.reserve(cells);
    scale_.gaussians.reserve(gaussians);
  }

  /// Starts the next cell, in key order.
  void addCell(const CellKey<D>& key) {
    startCell();
    scale_.keys.push_back(key);
  }
  /// Adds the exact moments of the current cell, which are its only Gaussian.
  void addMoments(const CellMoments<D>& moments) {
    scale_.moments.push_back(moments);
    ++gaussians_;
  }
  /// Adds a Gaussian to the current cell. Its mean is relative to the centre of the cell.
  void addGaussian(const Gaussian<D>& gaussian) {
    scale_.gaussians.push_back(gaussian);
    ++gaussians_;
  }
  /// Add to the optional columns. Call each of them for every Gaussian or never.
  void addLogOdds(float log_odds) { scale_.log_odds.push_back(log_odds); }
  void addParent(std::size_t parent) { scale_.parent.push_back(static_cast<std::uint32_t>(parent)); }
  /// Coarse scales: adds the index of the first child of the current cell. take() gets the end of the last cell's
  /// children.
  void addFirstChild(std::size_t child) { scale_.first_child.push_back(static_cast<std::uint32_t>(child)); }

  /// Copies Gaussian `index` of another scale into the current cell: its moments or Gaussian, and its log-odds.
  void copyGaussian(const MapScale<D>& from, std::size_t index) {
    if (from.gaussians.empty())
      addMoments(from.moments[index]);
    else
      addGaussian(from.gaussians[index]);
    if (!from.log_odds.empty()) addLogOdds(from.log_odds[index]);
  }
  /// Copies a cell with all its Gaussians, without links.
  void copyCell(const MapScale<D>& from, std::size_t cell) {
    addCell(from.keys[cell]);
    const IndexRange range = gaussiansOf(from, cell);
    for (std::size_t i = range.first; i < range.last; ++i) copyGaussian(from, i);
  }

  std::size_t cells() const { return scale_.keys.size(); }
  std::size_t gaussians() const { return gaussians_; }
  /// Returns the key of the current cell. addCell() must have been called.
  const CellKey<D>& key() const { return scale_.keys.back(); }

  /// Returns the finished scale. The builder is empty afterwards.
  MapScale<D> take() {
    startCell();
    gaussians_ = 0;
    return std::exchange(scale_, {});
  }
  /// Returns a finished coarse scale; `children` is the number of cells of the finer scale.
  MapScale<D> take(std::size_t children) {
    addFirstChild(children);
    return take();
  }

 private:
  /// Stores where a cell starts, as soon as some cell does not hold exactly one Gaussian.
  void startCell() {
    std::vector<std::uint32_t>& starts = scale_.first_gaussian;
    if (starts.empty()) {
      if (gaussians_ == scale_.keys.size()) return;
      for (std::size_t cell = 0; cell < scale_.keys.size(); ++cell) starts.push_back(static_cast<std::uint32_t>(cell));
    }
    starts.push_back(static_cast<std::uint32_t>(gaussians_));
  }

  MapScale<D> scale_;
  std::size_t gaussians_ = 0;
};

}  // namespace gaussmap::detail
