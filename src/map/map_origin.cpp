// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_origin.h"

#include <algorithm>
#include <limits>

namespace gaussmap::detail {

Vector<3> mapOrigin(const GaussianMap<3>& map) {
  constexpr double kStep = 1024.0;  // [m]
  const int coarsest = map.scales() - 1;
  if (map.empty()) return Vector<3>::Zero();
  const double half = 0.5 * map.grid().side(coarsest);
  Vector<3> low = Vector<3>::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const CellKey<3>& key : map.scale(coarsest).keys) {
    const Vector<3> centre = map.grid().centre(key, coarsest);
    low = low.cwiseMin((centre.array() - half).matrix());
    high = high.cwiseMax((centre.array() + half).matrix());
  }
  const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  if (farthest * std::numeric_limits<float>::epsilon() <= 1e-3 * map.grid().side(0)) return Vector<3>::Zero();
  return ((0.5 / kStep) * (low + high)).array().round().matrix() * kStep;
}

Gaussian<3> gaussianAbout(const Vector<3>& origin, const GaussianMap<3>& map, std::size_t index, int scale) {
  const CellKey<3>& key = map.scale(scale).keys[map.cellOf(index, scale)];
  Gaussian<3> gaussian = map.localGaussian(index, scale);
  gaussian.mean += map.grid().centre(key, scale) - origin;
  return gaussian;
}

}  // namespace gaussmap::detail
