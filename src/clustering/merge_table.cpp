// SPDX-License-Identifier: BSD-3-Clause
// Compiled without fused multiply-adds, so results are bit-identical on every machine.
#include "merge_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/function_clones.h"
#include "small_cholesky.h"

namespace gaussmap::detail {
namespace {

// The compiler vectorises a loop over pairs only if the loops inside it are unrolled first.
#define GAUSSMAP_UNROLL _Pragma("GCC unroll 16")
#define GAUSSMAP_INLINE inline __attribute__((always_inline))

constexpr double kLargest = 1e300;  // limits of a determinant; they keep costs finite
constexpr double kSmallest = 1e-300;
constexpr double kRemoved = -1e300;  // the size of a removed slot is smaller
constexpr double kMaxWeight = 1e100;
constexpr std::size_t kMaxData = 0x7FFFFFFF;

/// Returns ln x within 2 ulp for x in [1e-300, 1e300]. It uses only + - * /, because the logarithms of libraries differ
/// from machine to machine.
GAUSSMAP_INLINE double naturalLogarithm(double x) {
  constexpr std::uint64_t kRootHalf = 0x3FE6A09E667F3BCDull, kBias = 1023;
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint64_t exponent = (bits - kRootHalf + (kBias << 52)) >> 52;  // biased
  const std::uint64_t mantissa_bits = bits - ((exponent - kBias) << 52), exponent_bits = exponent | 0x433ull << 52;
  double mantissa, power;
  std::memcpy(&mantissa, &mantissa_bits, sizeof mantissa);  // in [sqrt(1/2), sqrt(2))
  std::memcpy(&power, &exponent_bits, sizeof power);        // 2^52 + exponent
  power -= 0x1.0p52 + static_cast<double>(kBias);
  const double s = (mantissa - 1.0) / (mantissa + 1.0), ss = s * s;  // ln m = 2 artanh s, |s| < 0.172
  double series = 1.0 / 21.0;
  GAUSSMAP_UNROLL
  for (int odd = 19; odd >= 3; odd -= 2) series = series * ss + 1.0 / odd;
  return power * 0.693147180559945309417 + 2.0 * (s + s * ss * series);
}

/// Returns the determinant of a symmetric matrix from its upper triangle by rows.
template <int D>
GAUSSMAP_INLINE double determinant(const double* m) {
  if constexpr (D == 2)
    return m[0] * m[2] - m[1] * m[1];
  else
    return m[0] * (m[3] * m[5] - m[4] * m[4]) - m[1] * (m[1] * m[5] - m[4] * m[2]) + m[2] * (m[1] * m[4] - m[3] * m[2]);
}

/// Limits a determinant, so that overflow does not reach the costs.
GAUSSMAP_INLINE double limited(double det) {
  det = det < kLargest ? det : kLargest;  // replaces NaN too
  return det > kSmallest ? det : kSmallest;
}

/// Returns det S of a cluster with scatter w S, limited so that rounding and overflow do not reach the costs.
template <int D>
GAUSSMAP_INLINE double covarianceDeterminant(const double* scatter, double inverse_weight) {
  double det = determinant<D>(scatter);
  GAUSSMAP_UNROLL
  for (int axis = 0; axis < D; ++axis) det *= inverse_weight;
  return limited(det);
}

template <int D>
double sizeOf(const double* scatter, double weight, MergeCost cost) {
  const double det = covarianceDeterminant<D>(scatter, 1.0 / weight);
  return cost == MergeCost::Runnalls ? weight * naturalLogarithm(det) : std::sqrt(det);
}

/// Inverts a covariance S = L D L', upper triangle by rows, and returns det S, limited. The pivots have a lower limit,
/// because rounding can make them 0 or negative. SmallCholesky is not used, because other files compile it with fused
/// multiply-adds.
template <int D>
double invert(const double* cov, double* inverse) {
  const auto pivot = [](double value, double diagonal) {
    const double least = 1e-16 * diagonal;
    return value > least ? value : least;  // replaces NaN too
  };
  const double first = pivot(cov[0], cov[0]), l10 = cov[1] / first;
  if constexpr (D == 2) {
    const double second = pivot(cov[2] - l10 * cov[1], cov[2]);
    inverse[2] = 1.0 / second;
    inverse[1] = -l10 / second;
    inverse[0] = 1.0 / first + l10 * l10 / second;
    return limited(first * second);
  } else {
    const double l20 = cov[2] / first;
    const double second = pivot(cov[3] - l10 * cov[1], cov[3]);
    const double rest = cov[4] - l20 * cov[1], l21 = rest / second;
    const double third = pivot(cov[5] - l20 * cov[2] - l21 * rest, cov[5]);
    const double m20 = l10 * l21 - l20;  // of L^-1, whose other entries are -l10 and -l21
    inverse[5] = 1.0 / third;
    inverse[4] = -l21 / third;
    inverse[3] = 1.0 / second + l21 * l21 / third;
    inverse[2] = m20 / third;
    inverse[1] = -l10 / second - l21 * m20 / third;
    inverse[0] = 1.0 / first + l10 * l10 / second + m20 * m20 / third;
    return limited(first * second * third);
  }
}

/// The cost loop of MergeCost::KL: per pair the smaller one of both divergences, eq. (8).
template <int D>
GAUSSMAP_INLINE void divergenceLoop(const MergeColumns<D>& columns, std::size_t i, std::size_t first, std::size_t last,
                                    double* __restrict out) {
  constexpr int kScatter = MergeColumns<D>::kScatter;
  constexpr int kRow[] = {0, 0, D == 2 ? 1 : 0, 1, 1, 2}, kColumn[] = {0, 1, D == 2 ? 1 : 2, 1, 2, 2};
  double mean_i[D], cov_i[kScatter], precision_i[kScatter];
  const double *mean[D], *scatter[kScatter], *precision[kScatter];
  const double inverse_i = 1.0 / columns.weight[i];
  GAUSSMAP_UNROLL
  for (int axis = 0; axis < D; ++axis) {
    mean_i[axis] = columns.mean[axis][i];
    mean[axis] = columns.mean[axis] + first;
  }
  GAUSSMAP_UNROLL
  for (int entry = 0; entry < kScatter; ++entry) {
    const double times = kRow[entry] == kColumn[entry] ? 1.0 : 2.0;  // the other triangle is equal
    cov_i[entry] = columns.scatter[entry][i] * inverse_i;
    precision_i[entry] = times * columns.precision[entry][i];
    scatter[entry] = columns.scatter[entry] + first;
    precision[entry] = columns.precision[entry] + first;
  }
  const double size_i = columns.size[i];
  const double *weight = columns.weight + first, *size = columns.size + first;
  const std::size_t count = last - first;
  for (std::size_t j = 0; j < count; ++j) {
    const double inverse = 1.0 / weight[j];
    double difference[D];
    GAUSSMAP_UNROLL
    for (int axis = 0; axis < D; ++axis) difference[axis] = mean_i[axis] - mean[axis][j];
    double to_j = 0.0, to_i = 0.0;  // tr((S_i + d d') S_j^-1) and tr((S_j + d d') S_i^-1)
    GAUSSMAP_UNROLL
    for (int entry = 0; entry < kScatter; ++entry) {
      const double apart = difference[kRow[entry]] * difference[kColumn[entry]];
      const double times = kRow[entry] == kColumn[entry] ? 1.0 : 2.0;
      to_j += (cov_i[entry] + apart) * (times * precision[entry][j]);
      to_i += (scatter[entry][j] * inverse + apart) * precision_i[entry];
    }
    double cost_j = 0.5 * ((to_j + (size[j] - size_i)) - D), cost_i = 0.5 * ((to_i + (size_i - size[j])) - D);
    cost_j = cost_j < kLargest ? cost_j : kLargest;  // replaces NaN too
    cost_i = cost_i < kLargest ? cost_i : kLargest;
    const double cost = cost_j < cost_i ? cost_j : cost_i;
    const bool is_removed = !(size_i > kRemoved && size[j] > kRemoved);
    out[j] = is_removed ? std::numeric_limits<double>::infinity() : cost;
  }
}

template <int D, MergeCost Cost>
GAUSSMAP_INLINE void costLoop(const MergeColumns<D>& columns, std::size_t i, std::size_t first, std::size_t last,
                              double* __restrict out) {
  constexpr int kScatter = MergeColumns<D>::kScatter;
  constexpr int kRow[] = {0, 0, D == 2 ? 1 : 0, 1, 1, 2}, kColumn[] = {0, 1, D == 2 ? 1 : 2, 1, 2, 2};
  double mean_i[D], scatter_i[kScatter];
  const double *mean[D], *scatter[kScatter];
  GAUSSMAP_UNROLL
  for (int axis = 0; axis < D; ++axis) {
    mean_i[axis] = columns.mean[axis][i];
    mean[axis] = columns.mean[axis] + first;
  }
  GAUSSMAP_UNROLL
  for (int entry = 0; entry < kScatter; ++entry) {
    scatter_i[entry] = columns.scatter[entry][i];
    scatter[entry] = columns.scatter[entry] + first;
  }
  const double weight_i = columns.weight[i], size_i = columns.size[i];
  const double *weight = columns.weight + first, *size = columns.size + first;
  const std::size_t count = last - first;
  for (std::size_t j = 0; j < count; ++j) {
    const double sum = weight_i + weight[j];
    const double inverse = 1.0 / sum;
    const double factor = weight_i * weight[j] * inverse;
    double difference[D], both[kScatter];
    GAUSSMAP_UNROLL
    for (int axis = 0; axis < D; ++axis) difference[axis] = mean_i[axis] - mean[axis][j];
    GAUSSMAP_UNROLL
    for (int entry = 0; entry < kScatter; ++entry)
      both[entry] =
          (scatter_i[entry] + scatter[entry][j]) + factor * difference[kRow[entry]] * difference[kColumn[entry]];
    const double det = covarianceDeterminant<D>(both, inverse);
    const double apart = size_i + size[j];
    if constexpr (Cost == MergeCost::Runnalls)
      out[j] = 0.5 * (sum * naturalLogarithm(det) - apart);
    else
      out[j] = std::sqrt(det) - apart;
  }
}

#define GAUSSMAP_COST_LOOP(D, Cost)                                                                     \
  GAUSSMAP_CLONES void costs##Cost##D(const MergeColumns<D>& columns, std::size_t i, std::size_t first, \
                                      std::size_t last, double* out) {                                  \
    costLoop<D, MergeCost::Cost>(columns, i, first, last, out);                                         \
  }
GAUSSMAP_COST_LOOP(2, Volume)
GAUSSMAP_COST_LOOP(3, Volume)
GAUSSMAP_COST_LOOP(2, Runnalls)
GAUSSMAP_COST_LOOP(3, Runnalls)
#undef GAUSSMAP_COST_LOOP
#define GAUSSMAP_COST_LOOP(D)                                                                                         \
  GAUSSMAP_CLONES void costsKL##D(const MergeColumns<D>& columns, std::size_t i, std::size_t first, std::size_t last, \
                                  double* out) {                                                                      \
    divergenceLoop<D>(columns, i, first, last, out);                                                                  \
  }
GAUSSMAP_COST_LOOP(2)
GAUSSMAP_COST_LOOP(3)
#undef GAUSSMAP_COST_LOOP

[[noreturn]] void refuse(std::size_t j, const std::string& what) {
  throw std::invalid_argument("agglomerate: Gaussian " + std::to_string(j) + ": the " + what);
}

template <int D>
void checkData(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas) {
  if (areas.size() != data.size())
    throw std::invalid_argument("agglomerate: " + std::to_string(areas.size()) + " areas for " +
                                std::to_string(data.size()) + " Gaussians: give one area per Gaussian");
  if (data.size() > kMaxData)
    throw std::invalid_argument("agglomerate: 2^31 Gaussians or more: at most 2^31 - 1 are supported");
  const auto usable = [](double value) { return value > 0.0 && value < kMaxWeight; };
  for (std::size_t j = 0; j < data.size(); ++j) {
    if (!usable(data[j].weight)) refuse(j, "weight must be above 0 and below 1e100");
    if (!usable(areas[j])) refuse(j, "area must be above 0 and below 1e100");
    if (!data[j].mean.allFinite()) refuse(j, "mean is not finite");
    if (!SmallCholesky<D>(data[j].cov).positive)
      throw std::domain_error("agglomerate: Gaussian " + std::to_string(j) +
                              ": the covariance is not positive definite; add a noise floor to its eigenvalues");
  }
}

/// Returns the middle between the extremes of the means. It does not depend on the order of the input.
template <int D>
Vector<D> middleOf(const std::vector<Gaussian<D>>& data) {
  if (data.empty()) return Vector<D>::Zero();
  Vector<D> low = data.front().mean, high = low;
  for (const Gaussian<D>& gaussian : data) {
    low = low.cwiseMin(gaussian.mean);
    high = high.cwiseMax(gaussian.mean);
  }
  return 0.5 * low + 0.5 * high;
}

}  // namespace

template <int D>
MergeTable<D>::MergeTable(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas, MergeCost cost)
    : cost_(cost), slots_(data.size()) {
  checkData<D>(data, areas);
  constexpr int kScatter = MergeColumns<D>::kScatter;
  values_.resize(slots_ * (D + kScatter + 2 + (cost == MergeCost::KL ? kScatter : 0)));
  double* column = values_.data();
  const auto nextColumn = [&] { return std::exchange(column, column + slots_); };
  for (double*& mean : columns_.mean) mean = nextColumn();
  for (double*& scatter : columns_.scatter) scatter = nextColumn();
  for (double*& precision : columns_.precision) precision = cost == MergeCost::KL ? nextColumn() : nullptr;
  columns_.weight = nextColumn();
  columns_.size = nextColumn();

  const Vector<D> middle = middleOf(data);
  for (std::size_t j = 0; j < slots_; ++j) {
    const double weight = cost == MergeCost::Volume ? areas[j] : data[j].weight;
    double scatter[kScatter];
    for (int row = 0, entry = 0; row < D; ++row) {
      columns_.mean[row][j] = data[j].mean(row) - middle(row);
      for (int column_of = row; column_of < D; ++column_of, ++entry)
        columns_.scatter[entry][j] = scatter[entry] = weight * data[j].cov(row, column_of);
    }
    columns_.weight[j] = weight;
    if (cost == MergeCost::KL)
      setPrecision(j);
    else
      columns_.size[j] = sizeOf<D>(scatter, weight, cost);
  }
}

template <int D>
void MergeTable<D>::setPrecision(std::size_t slot) {
  constexpr int kScatter = MergeColumns<D>::kScatter;
  double cov[kScatter], precision[kScatter];
  for (int entry = 0; entry < kScatter; ++entry) cov[entry] = columns_.scatter[entry][slot] / columns_.weight[slot];
  columns_.size[slot] = naturalLogarithm(invert<D>(cov, precision));
  for (int entry = 0; entry < kScatter; ++entry) columns_.precision[entry][slot] = precision[entry];
}

template <int D>
void MergeTable<D>::costs(std::size_t i, std::size_t first, std::size_t last, double* out) const {
  if constexpr (D == 2) {
    if (cost_ == MergeCost::KL) return costsKL2(columns_, i, first, last, out);
    if (cost_ == MergeCost::Runnalls) return costsRunnalls2(columns_, i, first, last, out);
    costsVolume2(columns_, i, first, last, out);
  } else {
    if (cost_ == MergeCost::KL) return costsKL3(columns_, i, first, last, out);
    if (cost_ == MergeCost::Runnalls) return costsRunnalls3(columns_, i, first, last, out);
    costsVolume3(columns_, i, first, last, out);
  }
}

template <int D>
void MergeTable<D>::unite(std::size_t a, std::size_t b) {
  constexpr int kScatter = MergeColumns<D>::kScatter;
  const double weight_a = columns_.weight[a], weight_b = columns_.weight[b];
  const double sum = weight_a + weight_b;
  const double factor = weight_a * weight_b * (1.0 / sum);
  double difference[D], scatter[kScatter];
  for (int axis = 0; axis < D; ++axis) {
    double* mean = columns_.mean[axis];
    difference[axis] = mean[a] - mean[b];
    mean[a] = (weight_a * mean[a] + weight_b * mean[b]) / sum;  // eq. (9)
  }
  for (int row = 0, entry = 0; row < D; ++row)
    for (int column = row; column < D; ++column, ++entry) {  // eq. (10), times the weight
      double* entries = columns_.scatter[entry];
      scatter[entry] = (entries[a] + entries[b]) + factor * difference[row] * difference[column];
      entries[a] = scatter[entry];
    }
  columns_.weight[a] = sum;
  if (cost_ == MergeCost::KL)
    setPrecision(a);
  else
    columns_.size[a] = sizeOf<D>(scatter, sum, cost_);
  columns_.size[b] = -std::numeric_limits<double>::infinity();
}

template <int D>
void MergeTable<D>::keep(const std::vector<std::uint32_t>& kept) {
  const auto squeeze = [&](double* column) {
    for (std::size_t slot = 0; slot < kept.size(); ++slot) column[slot] = column[kept[slot]];
  };
  for (double* mean : columns_.mean) squeeze(mean);
  for (double* scatter : columns_.scatter) squeeze(scatter);
  if (cost_ == MergeCost::KL)
    for (double* precision : columns_.precision) squeeze(precision);
  squeeze(columns_.weight);
  squeeze(columns_.size);
  slots_ = kept.size();
}

GAUSSMAP_CLONES std::size_t firstMinimum(const double* values, std::size_t size) {
  constexpr std::size_t kLanes = 16;
  double least = values[0];
  std::size_t i = 0;
  if (size >= kLanes) {
    double lane[kLanes];
    for (std::size_t l = 0; l < kLanes; ++l) lane[l] = values[l];
    for (i = kLanes; i + kLanes <= size; i += kLanes)
      for (std::size_t l = 0; l < kLanes; ++l) lane[l] = values[i + l] < lane[l] ? values[i + l] : lane[l];
    for (std::size_t l = 0; l < kLanes; ++l) least = lane[l] < least ? lane[l] : least;
  }
  for (; i < size; ++i) least = values[i] < least ? values[i] : least;
  i = 0;
  while (values[i] != least) ++i;
  return i;
}

template class MergeTable<2>;
template class MergeTable<3>;

}  // namespace gaussmap::detail
