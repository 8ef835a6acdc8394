// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap::test {

/// Returns the distance at which a beam from (ox, oy) in direction (dx, dy, .) enters or leaves a vertical cylinder;
/// infinity if it does not.
inline double meetsCylinder(double ox, double oy, double dx, double dy, double x, double y, double radius,
                            bool from_inside) {
  const double a = dx * dx + dy * dy, b = (ox - x) * dx + (oy - y) * dy;
  const double c = (ox - x) * (ox - x) + (oy - y) * (oy - y) - radius * radius, root = b * b - a * c;
  if (root < 0.0) return HUGE_VAL;
  const double range = (-b + (from_inside ? std::sqrt(root) : -std::sqrt(root))) / a;
  return range > 0.0 ? range : HUGE_VAL;
}

struct PostScan {
  bool has_post = false;
  bool organised = false;
  std::string label = "label";  // the name of the field, 1 = on the post
};

/// Returns scan `index` of a sensor that moves 0.1 m per scan through a round room (radius 10 m, floor 1.5 m below the
/// sensor). In some scans a post of 0.5 m radius is at (5, 0). Fields: x y z intensity (U2) label (U4) ring (U1, two of
/// them), binary, sensor frame, pose in VIEWPOINT.
inline std::string postScan(int index, const PostScan& scan) {
  constexpr int kRings = 24, kColumns = 360;
  constexpr double kPi = 3.14159265358979323846;
  const double ox = 0.0, oy = 0.1 * index;
  std::string body;
  for (int ring = 0; ring < kRings; ++ring)
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = kPi - 2.0 * kPi * (column + 0.5) / kColumns, elevation = (10.0 - ring) * kPi / 180.0;
      const double dx = std::cos(elevation) * std::cos(azimuth), dy = std::cos(elevation) * std::sin(azimuth);
      const double dz = std::sin(elevation);
      const double wall = meetsCylinder(ox, oy, dx, dy, 0.0, 0.0, 10.0, true), floor = dz < 0.0 ? -1.5 / dz : HUGE_VAL;
      const double post = scan.has_post ? meetsCylinder(ox, oy, dx, dy, 5.0, 0.0, 0.5, false) : HUGE_VAL;
      const double range = std::min({wall, floor, post});
      body += bytesOf(float(range * dx)) + bytesOf(float(range * dy)) + bytesOf(float(range * dz)) +
              bytesOf(std::uint16_t(ring * kColumns + column)) + bytesOf(std::uint32_t(range == post)) +
              bytesOf(std::uint8_t(ring)) + bytesOf(std::uint8_t(255 - ring));
    }
  const int width = scan.organised ? kColumns : kRings * kColumns, height = scan.organised ? kRings : 1;
  return "VERSION 0.7\nFIELDS x y z intensity " + scan.label +
         " ring\nSIZE 4 4 4 2 4 1\nTYPE F F F U U U\nCOUNT 1 1 1 1 1 2\nWIDTH " + std::to_string(width) + "\nHEIGHT " +
         std::to_string(height) + "\nVIEWPOINT 0 " + std::to_string(oy) + " 0 1 0 0 0\nPOINTS " +
         std::to_string(kRings * kColumns) + "\nDATA binary\n" + body;
}

/// Writes eight scans as FOLDER/scan0.pcd and so on. The post is in the first three scans.
inline void writePostScans(const TemporaryDirectory& directory, const std::string& folder, PostScan scan = {}) {
  std::filesystem::create_directories(directory.path() / folder);
  for (int i = 0; i < 8; ++i) {
    scan.has_post = i < 3;
    directory.write(folder + "/scan" + std::to_string(i) + ".pcd", postScan(i, scan));
  }
}

}  // namespace gaussmap::test
