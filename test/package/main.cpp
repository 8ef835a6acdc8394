// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <vector>

#include <gaussmap/io/gmap/map_file.h>
#include <gaussmap/mapping/build.h>
#include <gaussmap/mapping/refine.h>
#ifdef WITH_PCL
#include <gaussmap/pcl/conversions.h>
#endif

int main() {
  std::vector<gaussmap::Vector<3>> points;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y) points.emplace_back(0.05 * x, 0.05 * y, x < 50 ? 0.0 : 1.0);
  const gaussmap::GaussianMapOctree map = gaussmap::refine<3>(gaussmap::build<3>(points, {0.1, 10, 2, 0.0})).map;
  gaussmap::saveMap<3>(map, "stranger.gmap", {}, {true});
  const bool same = gaussmap::loadMap<3>("stranger.gmap").gaussianCount(1) == map.gaussianCount(1);
#ifdef WITH_PCL
  if (gaussmap::toPointCloud(map, 1).size() != map.gaussianCount(1)) return 1;
#endif
  std::printf("%zu Gaussians\n", map.gaussianCount(1));
  return same && map.weight(0) == 10000.0 ? 0 : 1;
}
