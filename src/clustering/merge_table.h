// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::detail {

/// Pointers to the columns of a MergeTable.
template <int D>
struct MergeColumns {
  static constexpr int kScatter = D * (D + 1) / 2;
  double* mean[D];              // relative to the middle of the input
  double* scatter[kScatter];    // weight * covariance, upper triangle by rows
  double* precision[kScatter];  // KL only: S^-1, upper triangle by rows
  double* weight;               // for the moment match: areas (Volume) or weights (Runnalls, KL)
  /// Volume: sqrt(det S), Runnalls: w ln det S, KL: ln det S; -infinity in a removed slot: merging with it costs
  /// infinity
  double* size;
};

/// The clusters that are being merged, one per slot, stored as columns. The costs of merging a cluster with all others
/// are then one loop in vector registers. Every operation gives bit-identical results for (a, b) and (b, a), in any
/// number of lanes.
template <int D>
class MergeTable {
 public:
  /// Throws like agglomerate(). `data` is not needed afterwards.
  MergeTable(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas, MergeCost cost);
  MergeTable(const MergeTable&) = delete;  // columns_ points into values_
  MergeTable& operator=(const MergeTable&) = delete;

  std::size_t slots() const { return slots_; }
  /// Writes the costs of merging slot i with slots [first, last) to out[0 ... last - first). A cost is never NaN.
  void costs(std::size_t i, std::size_t first, std::size_t last, double* out) const;
  double cost(std::size_t i, std::size_t j) const {
    double cost = 0.0;
    costs(i, j, j + 1, &cost);
    return cost;
  }
  /// Replaces slot a by the union of a and b, and removes slot b.
  void unite(std::size_t a, std::size_t b);
  /// Moves slots `kept` (ascending) to 0, 1, ... and removes all others.
  void keep(const std::vector<std::uint32_t>& kept);
  double mean(std::size_t slot, int axis) const { return columns_.mean[axis][slot]; }

 private:
  /// KL only: sets the precision and size of a slot from its scatter.
  void setPrecision(std::size_t slot);

  MergeCost cost_;
  std::size_t slots_;
  std::vector<double> values_;
  MergeColumns<D> columns_;
};

/// Returns the index of the smallest of `size` > 0 values; the first one if several are equal. No value may be NaN.
std::size_t firstMinimum(const double* values, std::size_t size);

}  // namespace gaussmap::detail
