// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "apps/app_fixture.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::test {

using Words = std::vector<std::string>;

/// Six scans in a room of 9 m x 6 m x 3 m with a cupboard, from a robot that drives a curve, and what people do to
/// them.
class MistakesTable : public AppTest {
 public:
  using AppTest::own;
  using AppTest::succeed;

  /// Points on the walls, floor and ceiling of the room [m, map frame]; different points in each scan.
  static std::vector<Vector<3>> room(unsigned scan) {
    std::mt19937 random(scan + 11);
    const auto uniform = [&](double low, double high) { return low + (high - low) * double(random()) / 4294967295.0; };
    const Eigen::Vector3d low(-1, -2, -1), high(8, 4, 2);
    std::vector<Vector<3>> points;
    for (int i = 0; i < 3000; ++i) {
      Vector<3> point(uniform(low.x(), high.x()), uniform(low.y(), high.y()), uniform(low.z(), high.z()));
      const unsigned face = random() % 8;
      if (face < 6)
        point(int(face / 2)) = face % 2 == 0 ? low(int(face / 2)) : high(int(face / 2));
      else
        point =
            face == 6 ? Vector<3>(5, uniform(2.5, 4), uniform(-1, 1)) : Vector<3>(uniform(5, 8), 2.5, uniform(-1, 1));
      points.push_back(point);
    }
    return points;
  }
  static Pose poseOf(unsigned scan) {
    const Eigen::AngleAxisd yaw(0.1 + 0.19 * scan, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd pitch(0.04 * scan, Eigen::Vector3d::UnitY());
    return {{0.4 + 0.7 * scan, 0.1 + 0.06 * scan * scan, 0.05 * scan}, Pose::Rotation(Eigen::Quaterniond(yaw * pitch))};
  }
  static std::vector<Vector<3>> seen(unsigned scan) {
    std::vector<Vector<3>> points = room(scan);
    for (Vector<3>& point : points) point = poseOf(scan).inverse() * Eigen::Vector3d(point);
    return points;
  }

  /// Writes six scans with these names and poses in VIEWPOINT, and returns their folder.
  std::string scans(
      const std::function<Pose(unsigned)>& viewpoint = poseOf,
      const std::function<std::string(unsigned)>& name = [](unsigned i) { return std::to_string(i); },
      const std::function<std::vector<Vector<3>>(unsigned)>& points = seen) const {
    std::filesystem::create_directories(own("scans"));
    for (unsigned i = 0; i < 6; ++i)
      writePcd(own("scans/" + name(i) + ".pcd"), points(i), PcdPrecision::Float, viewpoint(i));
    return own("scans");
  }
  std::string timed() const {
    return scans(poseOf, [](unsigned i) { return std::to_string(1700000000 + i) + ".5"; });
  }
  std::string inMapFrame() const { return scans(poseOf, number, room); }
  /// Scans in the map frame without sensor positions. A sensor sees at most 3 m.
  std::string withoutPositions() const {
    return scans([](unsigned) { return Pose(); }, number,
                 [](unsigned i) {
                   std::vector<Vector<3>> points = room(i);
                   const auto isFar = [i](const Vector<3>& point) {
                     return (Eigen::Vector3d(point) - poseOf(i).translation).norm() > 3.0;
                   };
                   points.erase(std::remove_if(points.begin(), points.end(), isFar), points.end());
                   return points;
                 });
  }

  static std::string text(const Pose& pose) {
    const Pose::Rotation& q = pose.rotation;
    std::ostringstream line;
    line.precision(12);
    line << pose.translation.transpose() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << q.w();
    return line.str();
  }
  /// The rows of the 3 x 4 matrix of a pose.
  static std::string kitti(unsigned i) {
    const Eigen::Matrix3d r = poseOf(i).rotation.toRotationMatrix();
    std::ostringstream line;
    line.precision(12);
    for (int row = 0; row < 3; ++row) line << r.row(row) << ' ' << poseOf(i).translation(row) << ' ';
    return line.str();
  }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(own(name), std::ios::binary) << content;
    return own(name);
  }
  /// Writes a line per scan: `key`, and the pose.
  std::string poses(
      const std::function<std::string(unsigned)>& key, unsigned first = 0,
      const std::function<std::string(unsigned)>& pose = [](unsigned i) { return text(poseOf(i)); }) const {
    std::string lines;
    for (unsigned i = first; i < 6; ++i) lines += key(i) + " " + pose(i) + "\n";
    return write("poses.txt", lines);
  }
  static std::string number(unsigned i) { return std::to_string(i); }

  Words build(const std::string& scans, const Words& more = {}) const {
    Words words = {"pcd2map", scans, "-o", own("map.gmap"), "--budget", "1", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Words withPoses(const std::string& scans, const std::string& poses) const { return build(scans, {"--poses", poses}); }
  /// Builds a map of the room and returns its name.
  std::string map(const std::string& name = "room.gmap") const {
    if (!std::filesystem::exists(own("scans"))) scans();
    succeed({"pcd2map", own("scans"), "-o", own(name), "--budget", "1"});
    return own(name);
  }
  std::string cloud(const std::string& name, const std::vector<Vector<3>>& points, const Pose& viewpoint = {},
                    PcdPrecision precision = PcdPrecision::Float) const {
    writePcd(own(name), points, precision, viewpoint);
    return own(name);
  }
  static std::vector<Vector<3>> moved(std::vector<Vector<3>> points, double scale, const Eigen::Vector3d& by) {
    for (Vector<3>& point : points) point = scale * point + by;
    return points;
  }
};

}  // namespace gaussmap::test
