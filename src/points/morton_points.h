// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/huge_pages.h"
#include "core/morton.h"
#include "core/parallel.h"
#include "gaussmap/points/normals.h"
#include "points/plane_batch.h"

namespace gaussmap::detail {

/// The indices first ... last - 1.
struct PointRange {
  std::uint32_t first = 0, last = 0;
  std::uint32_t size() const { return last - first; }
};

/// The root cube of an octree [m].
struct Cube {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();
  double side = 1.0;

  double cellsPerMetre() const { return double((1u << kMortonBits) - 1u) / side; }
  std::uint64_t codeOf(const float* p, double per_metre) const {
    std::uint64_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double place = (double(p[axis]) - low[axis]) * per_metre;
      cell[axis] = place > 0.0 ? std::min(std::uint64_t(std::min(place, 4e6)), std::uint64_t{2097151}) : 0u;
    }
    return mortonCode(cell[0], cell[1], cell[2]);
  }
  bool contains(const float* p) const {
    const Eigen::Vector3d high = low + Eigen::Vector3d::Constant(side);
    for (int axis = 0; axis < 3; ++axis)
      if (double(p[axis]) < low[axis] || double(p[axis]) > high[axis]) return false;
    return true;
  }
};

inline bool isFinite(const float* p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

/// The finite points within a cube, in Morton order.
struct SortedBlocks {
  MortonItems items;
  std::vector<std::array<float, 4>, PagesAllocator<std::array<float, 4>>> points;  // x y z 1, and padding

  SortedBlocks(const PointsView& view, const Cube& cube, int threads) {
    constexpr std::size_t kGrain = 4096;
    const double per_metre = cube.cellsPerMetre();
    items.resize(view.count);
    parallelFor(view.count, threads, kGrain, [&](std::size_t i) {
      const bool counts = isFinite(view[i]) && cube.contains(view[i]);
      items[i] = {counts ? cube.codeOf(view[i], per_metre) : kNoCode, std::uint32_t(i)};
    });
    items.erase(std::remove_if(items.begin(), items.end(), [](const MortonItem& item) { return item.code == kNoCode; }),
                items.end());
    MortonItems spare;
    sortByCode(items.data(), items.size(), spare);
    points.resize(items.size() + PlaneSums::kPadding);
    parallelFor(items.size(), threads, kGrain, [&](std::size_t i) {
      const float* const p = view[items[i].index];
      points[i] = {p[0], p[1], p[2], 1.0f};
    });
  }

 private:
  static constexpr std::uint64_t kNoCode = ~std::uint64_t{0};
};

/// Returns the 9 borders between the octants of a range of sorted items at a level. shift = 3 (level - 1).
inline std::array<std::uint32_t, 9> octantsOf(const MortonItems& items, PointRange range, int shift) {
  std::array<std::uint32_t, 9> border;
  border[0] = range.first;
  if (range.size() < 128) {
    std::uint64_t counts = 0;  // one byte per octant
    for (std::uint32_t i = range.first; i < range.last; ++i)
      counts += std::uint64_t{1} << 8 * (items[i].code >> shift & 7);
    const std::uint64_t ends = counts * 0x0101010101010101ull;
    for (std::uint32_t k = 0; k < 8; ++k) border[k + 1] = range.first + std::uint32_t(ends >> 8 * k & 255);
    return border;
  }
  for (std::uint32_t k = 1; k < 8; ++k) {
    const auto begin = items.begin();
    border[k] =
        std::uint32_t(std::partition_point(begin + border[k - 1], begin + range.last,
                                           [&](const MortonItem& item) { return (item.code >> shift & 7) < k; }) -
                      begin);
  }
  border[8] = range.last;
  return border;
}

/// Returns the smallest cube around the finite points of both.
inline Cube cubeOf(const PointsView& surface, const PointsView& queries) {
  Eigen::Array3d low = Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const PointsView* view : {&surface, &queries})
    for (std::size_t i = 0; i < view->count; ++i) {
      const float* const p = (*view)[i];
      if (!isFinite(p)) continue;
      const Eigen::Array3d point(p[0], p[1], p[2]);
      low = low.min(point);
      high = high.max(point);
    }
  Cube cube;
  if (!(low <= high).all()) return cube;
  cube.low = low;
  cube.side = (high - low).maxCoeff();
  if (cube.side == 0.0) cube.side = 1.0;
  return cube;
}

/// Returns a cube without outliers if it is much smaller than `all`, else `all`. The size of cells depends on the cube.
inline Cube withoutStrays(const Cube& all, const PointsView& surface) {
  constexpr std::size_t kMaxSamples = 4096;
  std::array<std::vector<float>, 3> axes;
  const std::size_t step = std::max<std::size_t>(1, surface.count / kMaxSamples);
  for (std::size_t i = 0; i < surface.count; i += step)
    if (isFinite(surface[i]))
      for (std::size_t axis = 0; axis < 3; ++axis) axes[axis].push_back(surface[i][axis]);
  if (axes[0].size() < 100) return all;
  Eigen::Array3d low, high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto few = std::ptrdiff_t(axes[axis].size() / 100);
    const auto begin = axes[axis].begin(), end = axes[axis].end(), lower = begin + few, upper = end - 1 - few;
    std::nth_element(begin, lower, end);
    std::nth_element(lower + 1, upper, end);  // does not move *lower
    low[Eigen::Index(axis)] = double(*lower);
    high[Eigen::Index(axis)] = double(*upper);
  }
  const double extent = (high - low).maxCoeff();
  Cube cube;
  cube.side = 21.0 * extent;
  cube.low = 0.5 * (low + high) - 0.5 * cube.side;
  return extent > 0.0 && cube.side < 0.1 * all.side ? cube : all;
}

}  // namespace gaussmap::detail
