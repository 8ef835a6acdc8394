// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/points/normals.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/parallel.h"
#include "points/cell_blocks.h"
#include "points/morton_points.h"
#include "points/plane_batch.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kWorthAFinerBlock = 2.5;  // times min_points: with fewer points, a finer block rarely has enough
constexpr std::size_t kParts = 64;         // parallel tasks per level
constexpr std::size_t kGrain = 512;
constexpr int kMaxMinPoints = 1000;

/// The unfinished cells of one octree level, or of one task's share of it.
struct OpenCells {
  std::vector<OpenCell> cells;
  std::vector<Near> near;
};

class OctreeDescent {
 public:
  OctreeDescent(const SortedBlocks& surface, const SortedBlocks& queries, const Cube& cube, const NormalsView& normals,
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
    const PointRange all{0, std::uint32_t(surface_.items.size())};
    if (all.size() < 3) {
      writeNone();
      return without_;
    }
    cells_.resize(1);
    cells_[0].borders[8] = all.last;
    wanted_ = std::vector<std::atomic<std::uint8_t>>(1);
    wanted_[0] = 1;
    std::vector<OpenCells> open(1), next;
    open[0].cells.push_back({{0, std::uint32_t(queries_.items.size())}, 0, 1});
    open[0].near.push_back({0, kMiddle});
    for (int level = kMortonBits; level > 0 && !open.empty(); --level) {
      split(3 * (level - 1));
      const std::size_t parts = open.size() == 1 && open[0].cells.size() > kParts ? kParts : open.size();
      next.assign(parts, {});
      parallelFor(parts, options_.threads, 1, [&](std::size_t part) {
        const bool is_cut = parts != open.size();
        const OpenCells& from = open[is_cut ? 0 : part];
        const std::size_t size = from.cells.size();
        const std::size_t first = is_cut ? size * part / parts : 0, last = is_cut ? size * (part + 1) / parts : size;
        Writer writer(*this);
        for (std::size_t i = first; i < last; ++i) visit(from, from.cells[i], level, writer, next[part]);
        writer.flush();
      });
      open.clear();
      for (OpenCells& part : next)
        if (!part.cells.empty()) open.push_back(std::move(part));
      cells_.swap(finer_cells_);
      wanted_.swap(finer_wanted_);
    }
    return without_;
  }

 private:
  /// Collects blocks and their queries until a batch is full. Then fits the planes and writes the normals.
  class Writer {
   public:
    explicit Writer(OctreeDescent& descent) : descent_(descent) {}
    void add(const PlaneSums& sums, PointRange queries) {
      batch_.set(size_, sums);
      queries_[size_] = queries;
      if (++size_ == PlaneBatch::kCapacity) flush();
    }
    void flush() {
      if (size_ == 0) return;
      batch_.solve(descent_.rounding_);
      for (std::size_t i = 0; i < size_; ++i) descent_.write(batch_, i, queries_[i]);
      size_ = 0;
    }

   private:
    PlaneBatch batch_;
    OctreeDescent& descent_;
    std::size_t size_ = 0;
    std::array<PointRange, PlaneBatch::kCapacity> queries_;
  };

  void write(const PlaneBatch& batch, std::size_t i, PointRange queries) {
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

  /// Creates the children of all cells that are marked in wanted_.
  void split(int shift) {
    const std::size_t count = cells_.size();
    parallelFor(count, options_.threads, kGrain, [&](std::size_t i) {
      if (!wanted_[i].load(std::memory_order_relaxed)) return;
      OctreeCell& cell = cells_[i];
      cell.borders = octantsOf(surface_.items, cell.points(), shift);
      for (unsigned k = 0; k < 8; ++k) {
        const std::uint32_t has_points = cell.borders[k + 1] > cell.borders[k];
        cell.children |= has_points << k;
      }
    });
    std::uint32_t total = 0;
    for (OctreeCell& cell : cells_) {
      cell.first_child = total;
      total += kBitCount[cell.children];
    }
    finer_cells_.assign(total, {});
    finer_wanted_ = std::vector<std::atomic<std::uint8_t>>(total);
    parallelFor(count, options_.threads, kGrain, [&](std::size_t i) {
      const OctreeCell& cell = cells_[i];
      std::uint32_t child = cell.first_child;
      for (std::uint32_t bits = cell.children; bits; bits &= bits - 1) {
        const auto octant = std::size_t(__builtin_ctz(bits));
        finer_cells_[child].borders[0] = cell.borders[octant];
        finer_cells_[child++].borders[8] = cell.borders[octant + 1];
      }
    });
  }

  void visit(const OpenCells& from, const OpenCell& open, int level, Writer& writer, OpenCells& next) {
    const Near* const near = from.near.data() + open.first_near;
    Surroundings around;
    for (std::size_t i = 0; i < open.near_count; ++i) around.add(cells_[near[i].cell], near[i].place);
    const auto borders = same_ ? around.middle().borders : octantsOf(queries_.items, open.queries, 3 * (level - 1));
    unsigned with_queries = 0;
    for (unsigned k = 0; k < 8; ++k) with_queries |= unsigned(borders[k + 1] > borders[k]) << k;
    for (; with_queries; with_queries &= with_queries - 1) {
      const auto k = unsigned(__builtin_ctz(with_queries));
      const PointRange queries{borders[k], borders[k + 1]};
      PlaneRanges ranges;
      const std::uint64_t octants = around.three(k);
      std::uint32_t count = around.gatherThree(k, octants, ranges);
      if (count >= enough_ && level > 1) {
        finer(around, k, octants, queries, next);
        continue;
      }
      if (count < min_) count += around.gatherFive(k, ranges);
      if (count < min_) {
        ranges.clear();
        PlaneRanges::Adder adder(ranges);
        for (std::size_t i = 0; i < open.near_count; ++i)
          adder.add(cells_[near[i].cell].borders[0], cells_[near[i].cell].borders[8]);
      }
      writer.add(sumUp(surface_.points.data(), ranges), queries);
    }
  }

  void finer(const Surroundings& around, unsigned k, std::uint64_t octants, PointRange queries, OpenCells& next) {
    const std::size_t first = next.near.size();
    around.append(k, octants, next.near);
    next.cells.push_back({queries, std::uint32_t(first), std::uint32_t(next.near.size() - first)});
    for (std::size_t i = first; i < next.near.size(); ++i)
      finer_wanted_[next.near[i].cell].store(1, std::memory_order_relaxed);
  }

  const SortedBlocks& surface_;
  const SortedBlocks& queries_;
  const NormalsView& normals_;
  const PointNormalOptions& options_;
  double rounding_ = 0.0;
  std::uint32_t min_ = 3, enough_ = 3;
  bool same_ = false;  // queries and surface are the same points
  std::atomic<std::size_t> without_{0};
  std::vector<OctreeCell> cells_, finer_cells_;
  std::vector<std::atomic<std::uint8_t>> wanted_, finer_wanted_;  // cells to split: a finer block may use their points
};

void checkOptions(const PointNormalOptions& options, std::size_t points) {
  require(options.min_points >= 3 && options.min_points <= kMaxMinPoints, "min_points", options.min_points,
          "must be 3 to " + std::to_string(kMaxMinPoints));
  if (!options.viewpoint.allFinite()) throw std::invalid_argument("the viewpoint is not finite");
  if (points >= std::size_t{1} << 31)
    throw std::invalid_argument(std::to_string(points) + " points: at most 2^31 - 1 are supported");
}

/// Computes the normals of the queries within the cube. Returns the number of queries without a normal.
std::size_t normalsWithin(const Cube& cube, const PointsView& surface, const PointsView& queries,
                          const NormalsView& normals, const PointNormalOptions& options) {
  const SortedBlocks points(surface, cube, options.threads);
  if (surface.first == queries.first && surface.count == queries.count && surface.stride == queries.stride)
    return OctreeDescent(points, points, cube, normals, options).run();
  return OctreeDescent(points, SortedBlocks(queries, cube, options.threads), cube, normals, options).run();
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
