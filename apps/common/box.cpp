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

template <int D>
Box<D> mapBoxOf(const std::string& option, const std::vector<double>& n) {
  Box<3> box = boxOf(option, n);
  if constexpr (D == 2) {
    if (n.size() != 4) throw UsageError(option + ": a planar map has no heights; give x0 y0 x1 y1");
    return {box.low.head<2>(), box.high.head<2>()};
  } else {
    return box;
  }
}
template Box<2> mapBoxOf<2>(const std::string&, const std::vector<double>&);
template Box<3> mapBoxOf<3>(const std::string&, const std::vector<double>&);

template <int D>
std::string textOf(const Box<D>& box) {
  const auto corner = [](const Vector<D>& p) {
    std::string text = "[";
    for (int axis = 0; axis < D; ++axis) text += (axis > 0 ? " " : "") + formatted("%.2f", p(axis));
    return text + "]";
  };
  return corner(box.low) + " .. " + corner(box.high) + " m";
}
template std::string textOf(const Box<2>&);
template std::string textOf(const Box<3>&);

}  // namespace gaussmap::app
