// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/shapes.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

std::vector<double> sortedOnce(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// The plane cut along all sides of all blocks, and the level of each piece.
class Pieces {
 public:
  Pieces(const std::vector<Block>& blocks, double elsewhere) : elsewhere_(elsewhere) {
    for (const Block& block : blocks) {
      xs_.insert(xs_.end(), {block.x0, block.x1});
      ys_.insert(ys_.end(), {block.y0, block.y1});
    }
    xs_ = sortedOnce(xs_);
    ys_ = sortedOnce(ys_);
    columns_ = xs_.empty() ? 0 : static_cast<int>(xs_.size()) - 1;
    rows_ = ys_.empty() ? 0 : static_cast<int>(ys_.size()) - 1;
    levels_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), elsewhere);
    for (const Block& block : blocks)
      for (int column = 0; column < columns_; ++column)
        for (int row = 0; row < rows_; ++row)
          if (x(column) >= block.x0 && x(column) < block.x1 && y(row) >= block.y0 && y(row) < block.y1)
            levels_[place(column, row)] = block.level;
  }

  /// Returns rectangles of one level each, with rows joined where possible; their corners (x0, y0, x1, y1).
  std::vector<Block> flats() const {
    std::vector<Block> flats;
    std::vector<bool> done(levels_.size(), false);
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (done[place(column, row)]) continue;
        const double value = level(column, row);
        const auto fits = [&](int c, int r) { return !done[place(c, r)] && same(level(c, r), value); };
        int right = column + 1, top = row + 1;
        while (right < columns_ && fits(right, row)) ++right;
        const auto row_fits = [&](int r) {
          for (int c = column; c < right; ++c)
            if (!fits(c, r)) return false;
          return true;
        };
        while (top < rows_ && row_fits(top)) ++top;
        for (int r = row; r < top; ++r)
          for (int c = column; c < right; ++c) done[place(c, r)] = true;
        flats.push_back({x(column), y(row), x(right), y(top), value});
      }
    }
    return flats;
  }

  /// Returns the borders between different levels, in pieces of maximum length, with the lower level on the left.
  std::vector<Step> steps() const {
    std::vector<Step> steps;
    for (int column = 0; column <= columns_; ++column)
      addLine(
          rows_, [&](int row) { return std::pair(level(column - 1, row), level(column, row)); },
          [&](int row) { return Eigen::Vector2d(x(column), y(row)); }, steps);
    for (int row = 0; row <= rows_; ++row)  // seen along x, the left side is the upper one
      addLine(
          columns_, [&](int column) { return std::pair(level(column, row), level(column, row - 1)); },
          [&](int column) { return Eigen::Vector2d(x(column), y(row)); }, steps);
    return steps;
  }

 private:
  double x(int column) const { return xs_[static_cast<std::size_t>(column)]; }
  double y(int row) const { return ys_[static_cast<std::size_t>(row)]; }
  std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  double level(int column, int row) const {
    const bool is_inside = column >= 0 && row >= 0 && column < columns_ && row < rows_;
    return is_inside ? levels_[place(column, row)] : elsewhere_;
  }

  /// Adds the steps along one line of the plane. `levels` gives the levels (left, right) of a piece, `point` the point
  /// where a piece begins.
  template <typename Levels, typename Point>
  static void addLine(int pieces, const Levels& levels, const Point& point, std::vector<Step>& steps) {
    for (int first = 0, last = 0; first < pieces; first = last) {
      const auto [left, right] = levels(first);
      while (last < pieces && same(levels(last).first, left) && same(levels(last).second, right)) ++last;
      if (left < right) steps.push_back({point(first), point(last), left, right});
      if (right < left) steps.push_back({point(last), point(first), right, left});
    }
  }

  double elsewhere_;
  std::vector<double> xs_, ys_, levels_;
  int columns_ = 0, rows_ = 0;
};

TriangleMesh flat(const Block& block, double height) {
  return rectangleMesh({{block.x0, block.y0, height}, {block.x1 - block.x0, 0, 0}, {0, block.y1 - block.y0, 0}});
}

/// Returns the same surface, visible from its other side.
TriangleMesh turnedOver(TriangleMesh mesh) {
  for (TriangleMesh::Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

}  // namespace

TriangleMesh wallsMesh(const std::vector<Step>& steps) {
  TriangleMesh mesh;
  for (const Step& step : steps) {
    const Eigen::Vector3d foot(step.from.x(), step.from.y(), step.low);
    const Eigen::Vector2d along = step.to - step.from;
    append(mesh, rectangleMesh({foot, {0, 0, step.high - step.low}, {along.x(), along.y(), 0}}));
  }
  return mesh;
}

TriangleMesh terraceMesh(const std::vector<Block>& blocks) {
  const Pieces pieces(blocks, kNothing);
  TriangleMesh mesh = wallsMesh(pieces.steps());
  for (const Block& block : pieces.flats())
    if (!std::isnan(block.level)) append(mesh, flat(block, block.level));
  return mesh;
}

TriangleMesh roomsMesh(const std::vector<Block>& blocks) {
  const Pieces pieces(blocks, 0.0);
  TriangleMesh mesh = turnedOver(wallsMesh(pieces.steps()));  // here the higher ceiling is on the open side
  for (const Block& block : pieces.flats()) {
    if (block.level <= 0.0) continue;
    append(mesh, flat(block, 0.0));
    append(mesh, turnedOver(flat(block, block.level)));
  }
  return mesh;
}

std::vector<Step> outline(std::vector<Block> blocks) {
  for (Block& block : blocks) block.level = block.level > 0.0 ? -1.0 : 0.0;  // free space is the lower side
  return Pieces(blocks, 0.0).steps();
}

}  // namespace gaussmap::simulation
