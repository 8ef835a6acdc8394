// SPDX-License-Identifier: BSD-3-Clause
// Builds a map scan by scan, as on a robot, and deletes what has moved.   Usage: 04_online OUT.gmap
#include <gaussmap/gaussmap.h>

#include <cmath>
#include <cstdio>

/// Simulates a laser in the middle of a room of 8 x 6 x 2.5 m. With `with_box`, a box stands in front of one wall.
gaussmap::Scan scanOfRoom(bool with_box) {
  gaussmap::Scan scan;
  for (int row = -8; row <= 8; ++row)
    for (int column = 0; column < 720; ++column) {
      const double azimuth = column * 3.14159265 / 360.0, rise = std::tan(row * 0.03);
      const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), rise);
      double range = std::min(4.0 / std::abs(ray.x()), 3.0 / std::abs(ray.y()));
      if (with_box && ray.x() > 0.98) range = 2.0 / ray.x();
      scan.points.push_back(range * ray);
    }
  return scan;
}

int main(int, char** argv) {
  gaussmap::OnlineOptions options;
  options.map.resolution = 0.2;
  std::size_t deleted = 0;
  gaussmap::OnlineMapper<3> mapper(options);
  for (int i = 0; i < 12; ++i) deleted += mapper.add(scanOfRoom(i < 2)).deleted;
  gaussmap::SaveOptions replace;
  replace.overwrite = true;
  gaussmap::save(argv[1], mapper.map(), {}, replace);
  std::printf("%zu scans, %zu clusters deleted\n", mapper.scans(), deleted);
  return deleted > 0 ? 0 : 1;
}
