// SPDX-License-Identifier: BSD-3-Clause
#include "uniform_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gaussmap/mapping/build.h"

namespace gaussmap::refinement {
namespace {

MapOptions gridOptions(double side, double finest) {
  const int along = std::max(2, static_cast<int>(std::lround(side / finest)));
  return {side / along, along, 2, finest / 20.0};
}

std::size_t occupiedCells(const std::vector<Vector<3>>& points, const MapOptions& options) {
  const Grid<3> grid(options);
  std::vector<CellKey<3>> keys;
  for (const Vector<3>& point : points) {
    const CellKey<3> key = grid.keyOf(point, 1);
    if (keys.empty() || keys.back() != key) keys.push_back(key);  // consecutive points often share a cell
  }
  std::sort(keys.begin(), keys.end());
  return static_cast<std::size_t>(std::unique(keys.begin(), keys.end()) - keys.begin());
}

}  // namespace

GaussianMap<3> uniformGrid(const std::vector<Vector<3>>& points, std::size_t most, double widest, double finest) {
  const auto fits = [&](double side) { return occupiedCells(points, gridOptions(side, finest)) <= most; };
  if (!fits(widest)) throw std::invalid_argument("uniformGrid: more cells than Gaussians");
  double too_fine = finest, wide = widest;
  while (wide / too_fine > 1.001) {
    const double side = std::sqrt(wide * too_fine);
    (fits(side) ? wide : too_fine) = side;
  }
  return build<3>(points, gridOptions(wide, finest));
}

}  // namespace gaussmap::refinement
