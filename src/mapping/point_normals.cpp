// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/point_normals.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/parallel.h"
#include "mapping/cell_blocks.h"
#include "mapping/morton_points.h"
#include "mapping/plane_batch.h"

namespace gaussmap {
namespace {

constexpr double kWorthAFinerBlock = 2.5;  // times min_points: with fewer, finer blocks hardly ever have enough
constexpr std::size_t kParts = 64;         // of a level, for threads
constexpr std::size_t kGrain = 512;
constexpr int kMostMinPoints = 1000;  // below Lanes::kMost

class Descent {
 public:
  Descent(const Sorted& surface, const Sorted& queries, const Cube& cube, const NormalsView& normals,
          const PointNormalOptions& options)
      : surface_(surface), queries_(queries), normals_(normals), options_(options) {
    const double farthest = std::max(cube.low.cwiseAbs().maxCoeff(), (cube.low.array() + cube.side).abs().maxCoeff());
    rounding_ = std::pow(double(std::numeric_limits<float>::epsilon()) * farthest, 2);
    min_ = std::uint32_t(options.min_points);
    enough_ = std::uint32_t(std::ceil(kWorthAFinerBlock * options.min_points));
    same_ = &surface == &queries;
  }

  /// Returns how many queries have no normal.
  std::size_t run() {
    if (queries_.items.empty()) return 0;
    const Range all{0, std::uint32_t(surface_.items.size())};
    if (all.size() < 3) {
      writeNone();
      return without_;
    }
    cells_.resize(1);
    cells_[0].points = all;
    wanted_ = std::vector<std::atomic<std::uint8_t>>(1);
    wanted_[0] = 1;
    std::vector<std::vector<Open>> open(1), next;
    open[0].push_back({{0, std::uint32_t(queries_.items.size())}, {}});
    open[0][0].near.fill(kNoCell);
    open[0][0].near[13] = 0;
    for (int level = kMortonBits; level > 0 && !open.empty(); --level) {
      split(3 * (level - 1));
      if (open.size() == 1 && open[0].size() > kParts) open = cut(std::move(open[0]));
      next.assign(open.size(), {});
      parallelFor(open.size(), options_.threads, 1, [&](std::size_t part) {
        Writer writer(*this);
        for (const Open& cell : open[part]) visit(cell, level, writer, next[part]);
        writer.flush();
      });
      open.clear();
      for (std::vector<Open>& part : next)
        if (!part.empty()) open.push_back(std::move(part));
      cells_.swap(finer_cells_);
      wanted_.swap(finer_wanted_);
    }
    return without_;
  }

 private:
  /// Blocks whose planes are still to be made, with the queries that get them.
  class Writer {
   public:
    explicit Writer(Descent& descent) : descent_(descent) {}
    void add(const PlaneSums& sums, Range queries) {
      batch_.set(size_, sums);
      queries_[size_] = queries;
      if (++size_ == PlaneBatch::kCapacity) flush();
    }
    void flush() {
      batch_.solve(descent_.rounding_);
      for (std::size_t i = 0; i < size_; ++i) descent_.write(batch_, i, queries_[i]);
      size_ = 0;
    }

   private:
    Descent& descent_;
    PlaneBatch batch_;
    std::array<Range, PlaneBatch::kCapacity> queries_;
    std::size_t size_ = 0;
  };

  void write(const PlaneBatch& batch, std::size_t i, Range queries) {
    const Eigen::Vector3d normal(batch.normal[0][i], batch.normal[1][i], batch.normal[2][i]);
    if (!std::isfinite(normal.x())) without_ += queries.size();
    for (std::uint32_t j = queries.first; j < queries.last; ++j) {
      const auto& p = queries_.points[j];
      const Eigen::Vector3d view = options_.viewpoint - Eigen::Vector3d(p[0], p[1], p[2]);
      const double sign = view.dot(normal) < 0.0 ? -1.0 : 1.0;
      const std::size_t record = queries_.items[j].index * normals_.stride;
      for (int axis = 0; axis < 3; ++axis) normals_.normal[record + std::size_t(axis)] = float(sign * normal[axis]);
      normals_.curvature[record] = float(batch.curvature[i]);
    }
  }

  void writeNone() {
    PlaneBatch none;
    none.solve(0.0);
    write(none, 0, {0, std::uint32_t(queries_.items.size())});
  }

  static std::vector<std::vector<Open>> cut(std::vector<Open> open) {
    std::vector<std::vector<Open>> parts(kParts);
    for (std::size_t part = 0; part < kParts; ++part)
      parts[part].assign(open.begin() + std::ptrdiff_t(open.size() * part / kParts),
                         open.begin() + std::ptrdiff_t(open.size() * (part + 1) / kParts));
    return parts;
  }

  /// Makes the children of all cells that are wanted.
  void split(int shift) {
    const std::size_t count = cells_.size();
    parallelFor(count, options_.threads, kGrain, [&](std::size_t i) {
      if (!wanted_[i].load(std::memory_order_relaxed)) return;
      Cell& cell = cells_[i];
      const auto borders = octantsOf(surface_.items, cell.points, shift);
      for (unsigned k = 0; k < 8; ++k) {
        const std::uint32_t size = borders[k + 1] - borders[k];
        cell.counts.add(k, std::min(size, Lanes::kMost));
        cell.children = std::uint8_t(cell.children | unsigned(size > 0) << k);
      }
      std::copy_n(borders.begin() + 1, 7, cell.ends.begin());
    });
    std::uint32_t total = 0;
    for (Cell& cell : cells_) {
      cell.first_child = total;
      total += kBitCount[cell.children];
    }
    finer_cells_.resize(total);
    finer_wanted_ = std::vector<std::atomic<std::uint8_t>>(total);
    parallelFor(count, options_.threads, kGrain, [&](std::size_t i) {
      const Cell& cell = cells_[i];
      std::uint32_t child = cell.first_child;
      for (unsigned bits = cell.children; bits; bits &= bits - 1) {
        finer_cells_[child] = Cell();
        finer_cells_[child++].points = cell.octant(unsigned(__builtin_ctz(bits)));
      }
    });
  }

  void visit(const Open& open, int level, Writer& writer, std::vector<Open>& next) {
    std::array<Lanes, 27> counts;
    for (std::size_t i = 0; i < 27; ++i) counts[i] = open.near[i] == kNoCell ? Lanes() : cells_[open.near[i]].counts;
    std::array<std::uint32_t, 9> borders;
    if (!same_) borders = octantsOf(queries_.items, open.queries, 3 * (level - 1));
    for (unsigned k = 0; k < 8; ++k) {
      const Range queries = same_ ? cells_[open.near[13]].octant(k) : Range{borders[k], borders[k + 1]};
      if (queries.size() == 0) continue;
      Lanes in;
      for (const Share& share : kBlocks.three[k]) in.addMasked(counts[share.cell], share.lanes);
      const std::uint32_t three = in.total();
      if (three >= enough_ && level > 1) {
        next.push_back(finer(open, k, queries));
        continue;
      }
      if (three < min_)
        for (const Share& share : kBlocks.five[k]) in.addMasked(counts[share.cell], share.lanes);
      PlaneRanges ranges;
      if (in.total() >= min_) {
        gather(ranges, open, kBlocks.three[k]);
        if (three < min_) gather(ranges, open, kBlocks.five[k]);
      } else {
        for (const std::uint32_t cell : open.near)
          if (cell != kNoCell) ranges.add(cells_[cell].points.first, cells_[cell].points.last);
      }
      writer.add(sumUp(surface_.points.data(), ranges), queries);
    }
  }

  void gather(PlaneRanges& ranges, const Open& open, const std::vector<Share>& shares) const {
    for (const Share& share : shares) {
      if (open.near[share.cell] == kNoCell) continue;
      const Cell& cell = cells_[open.near[share.cell]];
      for (unsigned bits = cell.children & share.octants; bits; bits &= bits - 1) {
        const Range points = cell.octant(unsigned(__builtin_ctz(bits)));
        ranges.add(points.first, points.last);
      }
    }
  }

  Open finer(const Open& open, std::size_t octant, Range queries) {
    Open child{queries, {}};
    for (std::size_t i = 0; i < 27; ++i) {
      const auto& [near, k] = kBlocks.near[octant][i];
      child.near[i] = kNoCell;
      if (open.near[near] == kNoCell) continue;
      const Cell& cell = cells_[open.near[near]];
      if (!(cell.children >> k & 1u)) continue;
      child.near[i] = cell.child(k);
      finer_wanted_[child.near[i]].store(1, std::memory_order_relaxed);
    }
    return child;
  }

  const Sorted& surface_;
  const Sorted& queries_;
  const NormalsView& normals_;
  const PointNormalOptions& options_;
  double rounding_ = 0.0;
  std::uint32_t min_ = 3, enough_ = 3;
  bool same_ = false;
  std::atomic<std::size_t> without_{0};
  std::vector<Cell> cells_, finer_cells_;
  std::vector<std::atomic<std::uint8_t>> wanted_, finer_wanted_;  // to be split: some finer block may hold their points
};

void checkOptions(const PointNormalOptions& options, std::size_t points) {
  if (options.min_points < 3 || options.min_points > kMostMinPoints)
    throw std::invalid_argument("min_points = " + std::to_string(options.min_points) + ": must be 3 ... " +
                                std::to_string(kMostMinPoints));
  if (!options.viewpoint.allFinite()) throw std::invalid_argument("the viewpoint is not finite");
  if (points >= std::size_t{1} << 31) throw std::invalid_argument(std::to_string(points) + " points: at most 2^31 - 1");
}

/// Of the queries within the cube; returns how many have none.
std::size_t normalsWithin(const Cube& cube, const PointsView& surface, const PointsView& queries,
                          const NormalsView& normals, const PointNormalOptions& options) {
  const Sorted points(surface, cube);
  if (surface.first == queries.first && surface.count == queries.count && surface.stride == queries.stride)
    return Descent(points, points, cube, normals, options).run();
  return Descent(points, Sorted(queries, cube), cube, normals, options).run();
}

}  // namespace

std::size_t pointNormals(const PointsView& surface, const PointsView& queries, const NormalsView& normals,
                         const PointNormalOptions& options) {
  checkOptions(options, std::max(surface.count, queries.count));
  const Cube all = cubeOf(surface, queries), cube = withoutStrays(all, surface);
  std::size_t without = 0;
  std::vector<std::size_t> strays;
  for (std::size_t i = 0; i < queries.count; ++i) {
    if (isFinite(queries[i]) && cube.contains(queries[i])) continue;
    if (isFinite(queries[i])) {
      strays.push_back(i);
      continue;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      normals.normal[i * normals.stride + axis] = std::numeric_limits<float>::quiet_NaN();
    normals.curvature[i * normals.stride] = std::numeric_limits<float>::quiet_NaN();
    ++without;
  }
  without += normalsWithin(cube, surface, queries, normals, options);
  if (strays.empty()) return without;

  std::vector<float> points, found(4 * strays.size());
  for (const std::size_t i : strays) points.insert(points.end(), queries[i], queries[i] + 3);
  without +=
      normalsWithin(all, surface, {points.data(), strays.size(), 3}, {found.data(), found.data() + 3, 4}, options);
  for (std::size_t j = 0; j < strays.size(); ++j) {
    std::copy_n(found.data() + 4 * j, 3, normals.normal + strays[j] * normals.stride);
    normals.curvature[strays[j] * normals.stride] = found[4 * j + 3];
  }
  return without;
}

}  // namespace gaussmap
