// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::detail {

/// Where the columns of a MergeTable are.
template <int D>
struct MergeColumns {
  static constexpr int kScatter = D * (D + 1) / 2;
  double* mean[D];            // about the middle of the data
  double* scatter[kScatter];  // weight * covariance, upper triangle by rows
  double* weight;             // of the moment match: areas, or masses
  double* size;               // sqrt(det S), or w ln det S; -infinity in a removed slot: merging with it costs infinity
};

/// Clusters that are merged, one a slot, as columns, so that the costs of a cluster with all others are one loop in
/// vector registers. Every operation gives the same bits for (a, b) as for (b, a), in any number of lanes.
template <int D>
class MergeTable {
 public:
  /// Throws as agglomerate() says. `data` are not needed any longer afterwards.
  MergeTable(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas, MergeCost cost);
  MergeTable(const MergeTable&) = delete;  // columns_ points into values_
  MergeTable& operator=(const MergeTable&) = delete;

  std::size_t slots() const { return slots_; }
  /// Costs of merging slot i with slots [first, last), to out[0 ... last - first). Never NaN.
  void costs(std::size_t i, std::size_t first, std::size_t last, double* out) const;
  double cost(std::size_t i, std::size_t j) const {
    double cost = 0.0;
    costs(i, j, j + 1, &cost);
    return cost;
  }
  /// Slot a becomes the union of a and b, slot b is removed.
  void unite(std::size_t a, std::size_t b);
  /// Slots `kept` (ascending) move to 0, 1, ...; all others are gone.
  void keep(const std::vector<std::uint32_t>& kept);
  double mean(std::size_t slot, int axis) const { return columns_.mean[axis][slot]; }

 private:
  MergeCost cost_;
  std::size_t slots_;
  std::vector<double> values_;
  MergeColumns<D> columns_;
};

/// Index of the smallest of `size` > 0 values, the first of several. No NaN.
std::size_t firstMinimum(const double* values, std::size_t size);

}  // namespace gaussmap::detail
