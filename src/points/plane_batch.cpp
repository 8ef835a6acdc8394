// SPDX-License-Identifier: BSD-3-Clause
#include "points/plane_batch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/function_clones.h"

namespace gaussmap::detail {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Newton's steps from 0 approach the smallest root of the characteristic polynomial from below and never pass it. Near
/// the root each step doubles the number of correct digits. A double smallest root (points on a line) is not needed.
constexpr int kSteps = 10;

GAUSSMAP_CLONES void solveAll(PlaneBatch& batch, double rounding) {
  for (std::size_t i = 0; i < PlaneBatch::kCapacity; ++i) {
    const double count = batch.counts[i], per_point = count > 0.0 ? 1.0 / count : 0.0;
    const double x = batch.products[3][i] * per_point, y = batch.products[7][i] * per_point;
    const double z = batch.products[11][i] * per_point;
    double xx = batch.products[0][i] * per_point - x * x, xy = batch.products[1][i] * per_point - x * y;
    double xz = batch.products[2][i] * per_point - x * z, yy = batch.products[5][i] * per_point - y * y;
    double yz = batch.products[6][i] * per_point - y * z, zz = batch.products[10][i] * per_point - z * z;
    const double trace = xx + yy + zz, scale = trace > rounding ? 1.0 / trace : 0.0;
    xx *= scale, xy *= scale, xz *= scale, yy *= scale, yz *= scale, zz *= scale;
    // l^3 - l^2 + minors l - det = 0, because the trace is 1.
    const double minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz;
    const double det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    double least = 0.0;
    for (int step = 0; step < kSteps; ++step) {
      const double value = ((least - 1.0) * least + minors) * least - det;
      const double slope = (3.0 * least - 2.0) * least + minors;
      least -= slope > 1e-30 ? value / slope : 0.0;
    }
    // Computes the other two roots from their sum and product.
    const double sum = 1.0 - least, product = minors - least * sum, inner = sum * sum - 4.0 * product;
    const double middle = 0.5 * (sum - std::sqrt(inner > 0.0 ? inner : 0.0));
    // The rows of A - l I are orthogonal to the eigenvector. Takes the longest of their cross products.
    const double ax = xx - least, by = yy - least, cz = zz - least;
    const double u0 = xy * yz - xz * by, u1 = xz * xy - ax * yz, u2 = ax * by - xy * xy;
    const double v0 = xy * cz - xz * yz, v1 = xz * xz - ax * cz, v2 = ax * yz - xy * xz;
    const double w0 = by * cz - yz * yz, w1 = yz * xz - xy * cz, w2 = xy * yz - by * xz;
    const double u = u0 * u0 + u1 * u1 + u2 * u2, v = v0 * v0 + v1 * v1 + v2 * v2, w = w0 * w0 + w1 * w1 + w2 * w2;
    const bool is_v = v > u;
    double n0 = is_v ? v0 : u0, n1 = is_v ? v1 : u1, n2 = is_v ? v2 : u2, square = is_v ? v : u;
    const bool is_w = w > square;
    n0 = is_w ? w0 : n0, n1 = is_w ? w1 : n1, n2 = is_w ? w2 : n2, square = is_w ? w : square;
    const bool is_plane = middle * trace > rounding && square > 1e-26;
    const double inverse = 1.0 / std::sqrt(is_plane ? square : 1.0);
    batch.normal[0][i] = is_plane ? n0 * inverse : kNone;
    batch.normal[1][i] = is_plane ? n1 * inverse : kNone;
    batch.normal[2][i] = is_plane ? n2 * inverse : kNone;
    batch.curvature[i] = is_plane ? (least > 0.0 ? least : 0.0) : kNone;
  }
}

using Point = std::array<float, 4>;
using Floats = float __attribute__((vector_size(32)));
using Doubles = double __attribute__((vector_size(64)));  // two points

/// Size of a buffer for the points of many ranges, one after another, for one loop over all of them. One loop per range
/// would cost more than its sums, because the lengths are almost random.
constexpr std::size_t kTogether = 256;

struct Products {
  Doubles origin, x{}, y{}, z{};
};

inline __attribute__((always_inline)) void addPairs(const Point* points, std::size_t count, Products& sums) {
  Doubles x = sums.x, y = sums.y, z = sums.z;
  for (std::size_t i = 0; i < count; i += 2) {
    Floats pair;
    std::memcpy(&pair, points + i, sizeof pair);
    const Doubles p = __builtin_convertvector(pair, Doubles) - sums.origin;
    x += __builtin_shufflevector(p, p, 0, 0, 0, 0, 4, 4, 4, 4) * p;
    y += __builtin_shufflevector(p, p, 1, 1, 1, 1, 5, 5, 5, 5) * p;
    z += __builtin_shufflevector(p, p, 2, 2, 2, 2, 6, 6, 6, 6) * p;
  }
  sums.x = x, sums.y = y, sums.z = z;
}

GAUSSMAP_CLONES void addAll(const Point* points, const PlaneRanges& ranges, PlaneSums& sums) {
  constexpr std::uint32_t kCopied = PlaneSums::kPadding;
  Point together[kTogether];
  const Point& about = points[ranges.first(0)];
  const double ox = double(about[0]), oy = double(about[1]), oz = double(about[2]);
  Products products{{ox, oy, oz, 0.0, ox, oy, oz, 0.0}};
  std::size_t size = 0;
  std::uint32_t count = 0;
  for (std::size_t range = 0; range < ranges.size(); ++range) {
    const std::uint32_t last = ranges.last(range);
    count += last - ranges.first(range);
    for (std::uint32_t i = ranges.first(range); i < last; i += kCopied) {
      std::memcpy(together + size, points + i, kCopied * sizeof(Point));
      size += std::min(last - i, kCopied);
      if (size <= kTogether - kCopied) continue;
      addPairs(together, size & ~std::size_t{1}, products);
      together[0] = together[size - 1];
      size &= 1;
    }
  }
  together[size] = {about[0], about[1], about[2], 0.0f};  // padding that adds nothing
  addPairs(together, size, products);
  for (std::size_t axis = 0; axis < 4; ++axis) {
    sums.product[axis] = products.x[axis] + products.x[axis + 4];
    sums.product[4 + axis] = products.y[axis] + products.y[axis + 4];
    sums.product[8 + axis] = products.z[axis] + products.z[axis + 4];
  }
  sums.count = count;
}

}  // namespace

PlaneSums sumUp(const std::array<float, 4>* points, const PlaneRanges& ranges) {
  PlaneSums sums;
  addAll(points, ranges, sums);
  return sums;
}

void PlaneBatch::solve(double rounding) {
  solveAll(*this, rounding);
}

}  // namespace gaussmap::detail
