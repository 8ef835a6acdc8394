// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/bags/bag_bytes.h"
#include "io/messages/memory_messages.h"

// The scans of a planar laser in a room, in every kind of file that can hold them.
namespace gaussmap::test {

/// A room of 8 m x 6 m around the origin. In the first scans a square post of 0.6 m stands at (2, 0).
struct PlanarRoom {
  static constexpr int kBeams = 385;
  static constexpr double kFirst = -3.0, kStep = 1.0 / 64.0;  // [rad], exact as floats
  static constexpr double kNoReturn = 0.0;

  /// Returns the pose of scan `i`: it moves by 5 cm per scan and turns.
  static Pose pose(int i) {
    const double half = 0.125 * i;
    Pose pose;
    pose.translation = {-1.5 + 0.05 * i, 0.02 * i, 0.0};
    pose.rotation = Pose::Rotation(std::cos(half), 0.0, 0.0, std::sin(half));
    return pose;
  }
  static double heading(int i) { return 0.25 * i; }

  /// Returns the distance to the border of a box around (x, y) from outside; infinity if the ray misses it.
  static double toBox(double ox, double oy, double dx, double dy, double x, double y, double half) {
    double enter = 0.0, leave = HUGE_VAL;
    const double o[2] = {ox - x, oy - y}, d[2] = {dx, dy};
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (-half - o[axis]) / d[axis], b = (half - o[axis]) / d[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : HUGE_VAL;
  }

  /// Returns the ranges of scan `i`, as floats. The first beam has no return.
  static std::vector<float> ranges(int i, bool with_post) {
    const Pose sensor = pose(i);
    const double x = sensor.translation.x(), y = sensor.translation.y();
    std::vector<float> ranges;
    for (int beam = 0; beam < kBeams; ++beam) {
      const double angle = heading(i) + kFirst + beam * kStep, dx = std::cos(angle), dy = std::sin(angle);
      double range = std::min(((dx < 0 ? -4.0 : 4.0) - x) / dx, ((dy < 0 ? -3.0 : 3.0) - y) / dy);
      if (with_post) range = std::min(range, toBox(x, y, dx, dy, 2.0, 0.0, 0.3));
      ranges.push_back(static_cast<float>(beam == 0 ? kNoReturn : range));
    }
    return ranges;
  }

  static std::vector<Vector<3>> points(int i, bool with_post) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vector<3>> points;
    const std::vector<float> all = ranges(i, with_post);
    for (int beam = 0; beam < kBeams; ++beam) {
      const double range = static_cast<double>(all[std::size_t(beam)]), angle = kFirst + beam * kStep;
      if (range > 0.0)
        points.emplace_back(range * std::cos(angle), range * std::sin(angle), 0.0);
      else
        points.emplace_back(kNaN, kNaN, kNaN);
    }
    return points;
  }

  /// A line ROBOTLASER1 of a log.
  static std::string line(int i, bool with_post) {
    std::string text = "ROBOTLASER1 0 -3.0 6.0 0.015625 80 0.01 0 " + std::to_string(kBeams);
    for (const float range : ranges(i, with_post)) text += number(static_cast<double>(range));
    const Pose sensor = pose(i);
    const std::string at = number(sensor.translation.x()) + number(sensor.translation.y()) + number(heading(i));
    return text + " 0" + at + at + " 0 0 0 0 0" + number(100.0 + 0.5 * i) + " host" + number(100.0 + 0.5 * i) + "\n";
  }
  static std::string log(int scans, int with_post = 0) {
    std::string text = "# a room\n";
    for (int i = 0; i < scans; ++i) text += line(i, i < with_post);
    return text;
  }
  static void writePcds(const std::filesystem::path& folder, int scans, int with_post = 0) {
    std::filesystem::create_directories(folder);
    for (int i = 0; i < scans; ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "scan%02d.pcd", i);
      writePcd(folder / name, points(i, i < with_post), PcdPrecision::Double, pose(i));
    }
  }

  /// A recording with messages of type LaserScan, and the poses as transforms at the same times.
  static std::string recording(int scans, int with_post = 0) {
    std::string data = mcap::schema(1, "sensor_msgs/msg/LaserScan") + mcap::schema(2, "tf2_msgs/msg/TFMessage") +
                       mcap::channel(1, 1, "/scan") + mcap::channel(2, 2, "/tf");
    for (int i = 0; i < scans; ++i) {
      const double time = 1700000000.0 + 0.5 * i;
      const auto stamp = static_cast<std::uint64_t>(time * 1e3) * 1000000;
      WireBytes transform(MessageEncoding::Cdr), laser(MessageEncoding::Cdr);
      transform.put(std::uint32_t{1}).header(time, "map").text("laser").pose(pose(i));
      laser.header(time, "laser");
      for (const double value : {kFirst, -kFirst, kStep, 0.0, 0.5, 0.01, 80.0}) laser.put(static_cast<float>(value));
      const std::vector<float> all = ranges(i, i < with_post);
      laser.put(static_cast<std::uint32_t>(all.size()));
      for (const float range : all) laser.put(range);
      laser.put(std::uint32_t{0});
      data += mcap::message(2, stamp, transform.str()) + mcap::message(1, stamp, laser.str());
    }
    return mcap::file(data);
  }

 private:
  static std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, " %.17g", value);
    return text;
  }
};

/// A log of 24 scans of the room, and a map of it, made once. The post leaves after the first four scans.
class PlanarApps : public AppTest {
 protected:
  static constexpr int kScans = 24, kWithPost = 4;
  using Words = std::vector<std::string>;

  static void SetUpTestSuite() {
    world_ = std::make_unique<TemporaryDirectory>();
    world_->write("room.log", PlanarRoom::log(kScans, kWithPost));
    PlanarRoom::writePcds(world("pcd"), kScans, kWithPost);
    ASSERT_EQ(runApp(planar({world("room.log"), "-o", world("room.gmap")})).code, 0);
    ASSERT_EQ(runApp({"pcd2map", world("room.log"), "-o", world("space.gmap"), "--resolution", "0.1"}).code, 0);
  }
  static void TearDownTestSuite() { world_.reset(); }

  static std::string world(const std::string& name) { return (world_->path() / name).string(); }
  static std::string room() { return world("room.gmap"); }
  static Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static Words planar(const Words& more) { return joined({"pcd2map", "--planar", "--resolution", "0.1"}, more); }

  static std::unique_ptr<TemporaryDirectory> world_;
};
inline std::unique_ptr<TemporaryDirectory> PlanarApps::world_;

}  // namespace gaussmap::test
