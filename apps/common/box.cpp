// SPDX-License-Identifier: BSD-3-Clause
#include "common/box.h"

#include <limits>

#include "common/report.h"
#include "common/usage.h"

namespace gaussmap::app {

Box<3> boxOf(const std::string& option, const std::vector<double>& n) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (n.size() != 4 && n.size() != 6)
    throw UsageError(option + ": " + std::to_string(n.size()) +
                     " numbers found, expected x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1");
  Box<3> box =
      n.size() == 4 ? Box<3>{{n[0], n[1], -kFar}, {n[2], n[3], kFar}} : Box<3>{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  if (!(box.low.array() < box.high.array()).all())
    throw UsageError(option + ": every coordinate of the first corner must be below that of the second corner");
  return box;
}

std::string textOf(const Box<3>& box) {
  const auto corner = [](const Vector<3>& p) {
    return "[" + formatted("%.2f ", p.x()) + formatted("%.2f ", p.y()) + formatted("%.2f]", p.z());
  };
  return corner(box.low) + " .. " + corner(box.high) + " m";
}

}  // namespace gaussmap::app
