// SPDX-License-Identifier: BSD-3-Clause
// Moving points in the scans of a depth camera, whose noise grows with the square of the depth.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/moving/moving_points.h"

namespace gaussmap {
namespace {

using Eigen::Vector3d;

/// Ten frames of a camera that moves along x through a room: a floor 1.2 m below the camera, a wall at z = 8 m, and in
/// the first three frames a box at z = 3 m. Each depth has the noise of a Kinect. Two frames see the wall 0.7 m too
/// near, as depth cameras do whose calibration is not exact.
struct Frames {
  static constexpr int kColumns = 160, kRows = 120, kFrames = 10;
  std::shared_ptr<MemoryScans> scans = std::make_shared<MemoryScans>();
  std::vector<std::vector<bool>> on_box;

  Frames() {
    Random random(3);
    for (int frame = 0; frame < kFrames; ++frame) {
      Scan scan;
      scan.columns = kColumns;
      scan.pose.translation = {0.15 * frame - 0.7, 0.0, 0.05 * frame};
      std::vector<bool> box;
      const double systematic = frame == 4 || frame == 7 ? -0.008 : 0.0;
      std::vector<double> errors(kRows * kColumns / 10);  // neighbours have the same: the camera matches windows
      for (double& error : errors) error = random.normal();
      for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
          const Vector3d ray((column - 79.5) / 130.0, (row - 59.5) / 130.0, 1.0);
          double depth = 8.0 - scan.pose.translation.z();
          if (ray.y() > 0.0) depth = std::min(depth, 1.2 / ray.y());
          const double at = 3.0 - scan.pose.translation.z();
          const double x = scan.pose.translation.x() + at * ray.x(), y = at * ray.y();
          box.push_back(frame < 3 && at < depth && std::abs(x) < 0.4 && y > -0.3 && y < 0.9);
          if (box.back()) depth = at;
          depth += systematic * depth * depth +
                   errors[std::size_t(row / 10 * kColumns + column) / 10] * DepthNoise::camera().at(depth);
          scan.points.push_back(depth * ray);
        }
      scans->add(scan);
      on_box.push_back(box);
    }
  }

  /// Returns the shares of the flagged points: on the box, and elsewhere.
  std::pair<double, double> flagged(const MovingPointOptions& options) const {
    const MovingPoints moving(scans, options);
    double on = 0.0, on_flagged = 0.0, off = 0.0, off_flagged = 0.0;
    for (std::size_t i = 0; i < scans->size(); ++i) {
      const std::vector<bool> flags = moving.inScan(i);
      for (std::size_t p = 0; p < flags.size(); ++p) {
        (on_box[i][p] ? on : off) += 1.0;
        if (flags[p]) (on_box[i][p] ? on_flagged : off_flagged) += 1.0;
      }
    }
    return {on_flagged / on, off_flagged / off};
  }
};

TEST(MovingPointsOfADepthCamera, AreThoseOfTheBoxAndNotTheFarWall) {
  const Frames frames;
  for (const double resolution : {0.1, 0.2}) {
    MovingPointOptions options;
    options.resolution = resolution;
    const auto [box, wall] = frames.flagged(options);
    EXPECT_GT(box, 0.9) << resolution;
    EXPECT_EQ(wall, 0.0) << resolution;
    options.evidence.visibility.noise = DepthNoise();  // as for a lidar: a part of the far wall seems to move
    EXPECT_GT(frames.flagged(options).second, 0.001) << resolution;
  }
}

TEST(MovingPointsOfADepthCamera, RefuseANoiseThatIsNoNumber) {
  MovingPointOptions options;
  const auto scans = std::make_shared<MemoryScans>();
  options.evidence.visibility.noise = DepthNoise{-0.1, 0.0, 0.0};
  EXPECT_THROW(MovingPoints(scans, options), std::invalid_argument);
  options.evidence.visibility.noise = DepthNoise{0.0, std::numeric_limits<double>::quiet_NaN(), 0.0};
  EXPECT_THROW(MovingPoints(scans, options), std::invalid_argument);
  options.evidence.visibility.noise = DepthNoise{0.0, 0.0, -1.0};
  EXPECT_THROW(MovingPoints(scans, options), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
