// SPDX-License-Identifier: BSD-3-Clause
#include "map/lattice.h"

#include <sstream>
#include <stdexcept>

namespace gaussmap::detail {

void throwOutsideLattice(const double* point, int dimension, double resolution) {
  std::ostringstream text;
  text.precision(10);
  text << "point (";
  for (int axis = 0; axis < dimension; ++axis) text << (axis ? ", " : "") << point[axis];
  text << ") does not fit 32-bit cell indices at a resolution of " << resolution
       << " m: use coarser cells, or check the units and the pose";
  throw std::out_of_range(text.str());
}

}  // namespace gaussmap::detail
