// SPDX-License-Identifier: BSD-3-Clause
// Builds a map of points in memory, saves and loads it, and finds a surface normal.   Usage: 01_points_to_map OUT.gmap
#include <gaussmap/gaussmap.h>

#include <cstdio>
#include <vector>

int main(int, char** argv) {
  std::vector<Eigen::Vector3d> points;  // a floor and a wall [m]
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) {
      points.emplace_back(0.02 * i, 0.02 * j, 0.0);
      points.emplace_back(0.02 * i, 4.0, 0.02 * j);
    }
  gaussmap::MapOptions options;
  options.resolution = 0.1;
  gaussmap::SaveOptions replace;
  replace.overwrite = true;
  gaussmap::save(argv[1], gaussmap::build(points, options), {}, replace);

  const gaussmap::GaussianMapOctree map = gaussmap::load(argv[1]);
  const auto normal = gaussmap::normalAt(map, Eigen::Vector3d(2.0, 2.0, 0.0));
  if (!normal) return 1;
  std::printf("%zu cells, normal of the floor %.2f %.2f %.2f\n", map.cellCount(0), normal->x(), normal->y(),
              normal->z());
}
