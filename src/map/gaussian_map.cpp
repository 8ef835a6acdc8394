// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/gaussian_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gaussmap {
namespace {

constexpr std::size_t kMaxEntries = 0xFFFFFFFFu;  // indices of cells and Gaussians have 32 bits
constexpr double kMaxOffset = 0.501;              // of a mean from the cell's centre, in sides: a half plus rounding

[[noreturn]] void refuse(int scale, const std::string& what) {
  throw std::invalid_argument("scale " + std::to_string(scale) + ": " + what);
}

/// Returns true if `starts` divides `total` entries into `parts` consecutive ranges.
bool cutsIntoRanges(const std::vector<std::uint32_t>& starts, std::size_t parts, std::size_t total) {
  return starts.size() == parts + 1 && starts.front() == 0 && starts.back() == total &&
         std::is_sorted(starts.begin(), starts.end());
}

bool hasEmptyRange(const std::vector<std::uint32_t>& starts) {
  return std::adjacent_find(starts.begin(), starts.end()) != starts.end();
}

template <int D>
void checkScale(const MapScale<D>& scale, int s, double side) {
  const std::size_t cells = scale.keys.size();
  if (cells > kMaxEntries || scale.gaussianCount() > kMaxEntries) refuse(s, "more than 2^32 - 1 entries");
  if (!scale.moments.empty()) {
    if (s > 0) refuse(s, "only the finest scale holds moments");
    if (!scale.gaussians.empty() || scale.moments.size() != cells) refuse(s, "moments do not match the cells");
    for (const CellMoments<D>& moments : scale.moments)
      if (moments.count <= 0) refuse(s, "a cell has no points");
  }
  for (const Gaussian<D>& gaussian : scale.gaussians) {
    if (!(gaussian.weight > 0.0 && std::isfinite(gaussian.weight)) || !gaussian.cov.allFinite())
      refuse(s, "a Gaussian's weight is not positive and finite, or its covariance is not finite");
    if (!gaussian.mean.allFinite() || gaussian.mean.cwiseAbs().maxCoeff() > kMaxOffset * side)
      refuse(s, "a Gaussian's mean lies outside its cell");
  }
  if (scale.first_gaussian.empty()
          ? scale.gaussianCount() != cells
          : !cutsIntoRanges(scale.first_gaussian, cells, scale.gaussianCount()) || hasEmptyRange(scale.first_gaussian))
    refuse(s, "Gaussians do not match the cells");
  if (!scale.log_odds.empty() && scale.log_odds.size() != scale.gaussianCount())
    refuse(s, "occupancies do not match the Gaussians");
  for (const float log_odds : scale.log_odds)
    if (!std::isfinite(log_odds)) refuse(s, "an occupancy is not finite");
}

template <int D>
double weightOf(const MapScale<D>& scale) {
  std::int64_t count = 0;
  for (const CellMoments<D>& moments : scale.moments) count += moments.count;
  double sum = static_cast<double>(count);
  for (const Gaussian<D>& gaussian : scale.gaussians) sum += gaussian.weight;
  return sum;
}

/// Checks that children are in the right cells and in key order, and that every parent is a cluster of the cell above.
template <int D>
void checkLinks(const GaussianMap<D>& map, int s) {
  const MapScale<D>&finer = map.scale(s - 1), &coarse = map.scale(s);
  if (!cutsIntoRanges(coarse.first_child, coarse.keys.size(), finer.keys.size()))
    refuse(s, "children do not match the cells of the finer scale");
  if (finer.parent.size() != finer.gaussianCount()) refuse(s - 1, "not every Gaussian has a parent");
  for (std::size_t cell = 0; cell < coarse.keys.size(); ++cell) {
    const IndexRange children = map.childCells(cell, s), clusters = map.gaussiansOf(cell, s);
    for (std::size_t child = children.first; child < children.last; ++child) {
      if (!map.grid().isParent(coarse.keys[cell], finer.keys[child]))
        refuse(s - 1, "cell " + toString<D>(finer.keys[child]) + " is a child of the wrong cell");
      if (child > children.first && !(finer.keys[child - 1] < finer.keys[child]))
        refuse(s - 1, "cell " + toString<D>(finer.keys[child]) + " is out of order or a duplicate");
    }
    const IndexRange under = map.gaussiansUnder(cell, s);
    for (std::size_t i = under.first; i < under.last; ++i)
      if (finer.parent[i] < clusters.first || finer.parent[i] >= clusters.last)
        refuse(s - 1, "the parent of a Gaussian is in the wrong cell");
  }
}

}  // namespace

template <int D>
GaussianMap<D>::GaussianMap(const MapOptions& options, std::vector<MapScale<D>> scales)
    : grid_(options), scales_(std::move(scales)) {
  if (scales_.size() != static_cast<std::size_t>(grid_.scales()))
    throw std::invalid_argument(std::to_string(scales_.size()) + " scales given, but the options have " +
                                std::to_string(grid_.scales()));
  for (int s = 0; s < grid_.scales(); ++s) checkScale<D>(scale(s), s, grid_.side(s));
  for (int s = 1; s < grid_.scales(); ++s) checkLinks<D>(*this, s);
  const std::vector<CellKey<D>>& coarsest = scales_.back().keys;
  if (std::adjacent_find(coarsest.begin(), coarsest.end(), [](auto& a, auto& b) { return !(a < b); }) != coarsest.end())
    refuse(grid_.scales() - 1, "cells are out of order or duplicated");
  for (const MapScale<D>& level : scales_) {
    weights_.push_back(weightOf<D>(level));
    compressed_ |= hasEmptyRange(level.first_child);
    if (level.gaussianCount() > 0 && level.log_odds.empty() == hasOccupancy())
      throw std::invalid_argument("some scales have occupancy and some do not");
  }
}

template <int D>
std::vector<MapScale<D>> GaussianMap<D>::takeScales() && {
  std::vector<MapScale<D>> scales(scales_.size());
  scales.swap(scales_);
  weights_.assign(scales.size(), 0.0);
  compressed_ = false;
  return scales;
}

template <int D>
std::optional<std::size_t> GaussianMap<D>::find(const CellKey<D>& key, int s) const {
  IndexRange range{0, cellCount(scales() - 1)};
  for (int level = scales() - 1;; --level) {
    const std::vector<CellKey<D>>& keys = scale(level).keys;
    const CellKey<D> wanted = level == s ? key : grid_.ancestor(key, s, level);
    const auto begin = keys.begin() + static_cast<std::ptrdiff_t>(range.first);
    const auto end = keys.begin() + static_cast<std::ptrdiff_t>(range.last);
    const auto found = std::lower_bound(begin, end, wanted);
    if (found == end || *found != wanted) return std::nullopt;
    const auto cell = static_cast<std::size_t>(found - keys.begin());
    if (level == s) return cell;
    range = childCells(cell, level);
  }
}

template <int D>
IndexRange GaussianMap<D>::gaussiansOf(std::size_t cell, int s) const {
  const std::vector<std::uint32_t>& first = scale(s).first_gaussian;
  if (first.empty()) return {cell, cell + 1};
  return {first[cell], first[cell + 1]};
}

template <int D>
std::size_t GaussianMap<D>::cellOf(std::size_t index, int s) const {
  const std::vector<std::uint32_t>& first = scale(s).first_gaussian;
  if (first.empty()) return index;
  return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), index) - first.begin()) - 1;
}

template <int D>
IndexRange GaussianMap<D>::childCells(std::size_t cell, int s) const {
  const std::vector<std::uint32_t>& first = scale(s).first_child;
  return {first[cell], first[cell + 1]};
}

template <int D>
IndexRange GaussianMap<D>::gaussiansUnder(std::size_t cell, int s) const {
  const IndexRange cells = childCells(cell, s);
  if (cells.empty()) return {0, 0};
  return {gaussiansOf(cells.first, s - 1).first, gaussiansOf(cells.last - 1, s - 1).last};
}

template <int D>
Gaussian<D> GaussianMap<D>::localGaussian(std::size_t index, int s) const {
  const MapScale<D>& level = scale(s);
  if (!level.moments.empty()) return level.moments[index].gaussian(grid_.side(s), options().noise);
  return level.gaussians[index];
}

template <int D>
Gaussian<D> GaussianMap<D>::gaussian(std::size_t index, int s) const {
  Gaussian<D> gaussian = localGaussian(index, s);
  gaussian.mean += grid_.centre(scale(s).keys[cellOf(index, s)], s);
  return gaussian;
}

template <int D>
std::vector<std::size_t> GaussianMap<D>::childrenOf(std::size_t index, int s) const {
  const std::vector<std::uint32_t>& parent = scale(s - 1).parent;
  const IndexRange under = gaussiansUnder(cellOf(index, s), s);
  std::vector<std::size_t> children;
  for (std::size_t i = under.first; i < under.last; ++i)
    if (parent[i] == index) children.push_back(i);
  return children;
}

template class GaussianMap<2>;
template class GaussianMap<3>;

}  // namespace gaussmap
