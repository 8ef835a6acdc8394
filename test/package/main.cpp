// SPDX-License-Identifier: BSD-3-Clause
#include <gaussmap/mapping/build.h>
#include <gaussmap/mapping/refine.h>
#include <gaussmap/version.h>

#include <cstdio>
#include <vector>

int main() {
  std::vector<gaussmap::Vector<3>> points;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y) points.emplace_back(0.05 * x, 0.05 * y, x < 50 ? 0.0 : 1.0);
  const gaussmap::GaussianMapOctree map =
      gaussmap::refine(gaussmap::build(points, {0.1, 10, 2, 0.0}), gaussmap::PerCell{3.0}).map;
  std::printf("gaussmap %s: %zu Gaussians\n", GAUSSMAP_VERSION, map.gaussianCount(1));
  return map.weight(0) == 10000.0 && map.gaussianCount(1) > map.cellCount(1) ? 0 : 1;
}
