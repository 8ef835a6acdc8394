// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/plan_view.h"

#include <limits>

namespace gaussmap::app {

double PlanView::drawScaleBar(Svg& svg, double left, double top, double pixels) const {
  const double metres = roundLength(pixels / scale), length = metres * scale;
  svg << "<path d='M" << left << ' ' << top << "v6h" << length << "v-6' fill='none' stroke='black'/>\n";
  svg.text(left + length / 2, top + 22, numberText(metres) + " m", "text-anchor='middle'");
  return length;
}

Box<2> emptyBox() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Vector<2>::Constant(kInfinity), Vector<2>::Constant(-kInfinity)};
}

void include(Box<2>& box, const Vector<2>& point) {
  box.low = box.low.cwiseMin(point);
  box.high = box.high.cwiseMax(point);
}

}  // namespace gaussmap::app
