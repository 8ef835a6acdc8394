// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/app_fixture.h"

namespace gaussmap::test {

inline constexpr double kPi = 3.14159265358979323846;

/// A line FLASER of 180 beams within a room of 8 m x 6 m round the origin.
inline std::string roomLine(double x, double y, double heading) {
  std::ostringstream line;
  line << "FLASER 180";
  for (int i = 0; i < 180; ++i) {
    const double bearing = heading + (i - 90) * kPi / 180.0, dx = std::cos(bearing), dy = std::sin(bearing);
    const double to_x = ((dx < 0 ? -4.0 : 4.0) - x) / dx, to_y = ((dy < 0 ? -3.0 : 3.0) - y) / dy;
    line << ' ' << std::min(to_x, to_y);
  }
  line << ' ' << x << ' ' << y << ' ' << heading << " 0 0 0 1 host 1\n";
  return line.str();
}

/// The sensor turns round in the room.
inline std::string roomLog(int scans) {
  std::string text = "# a room\n";
  for (int i = 0; i < scans; ++i)
    text += roomLine(0.5 * std::cos(0.37 * i), 0.5 * std::sin(0.53 * i), std::remainder(0.7 * i, 2.0 * kPi));
  return text;
}

class SegmentsApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "plan", "-o", world("plan"), "--scans", "80", "--columns", "181"}).code, 0);
    world_->write("room.log", roomLog(30));
    ASSERT_EQ(runApp({"segments", world("room.log"), "-o", world("room.pcd")}).code, 0);
  }
  static void TearDownTestSuite() { world_.reset(); }

  static std::string world(const std::string& name) { return (world_->path() / name).string(); }
  static Json jsonOf(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "segments");
    arguments.emplace_back("--json");
    return Json::parse(succeed(arguments));
  }
  static std::size_t linesOf(const std::string& path) {
    const std::string text = contentsOf(path);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> world_;
};

}  // namespace gaussmap::test
