// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/error_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
using namespace detail;

namespace {

const std::uint32_t kBlue = 0x0000FF, kCyan = 0x00FFFF, kGreen = 0x00FF00, kYellow = 0xFFFF00, kRed = 0xFF0000;

TEST(ErrorColour, GoesFromBlueOverGreenToRed) {
  EXPECT_EQ(errorColour(0.0, 2.0), kBlue);
  EXPECT_EQ(errorColour(0.5, 2.0), kCyan);
  EXPECT_EQ(errorColour(1.0, 2.0), kGreen);
  EXPECT_EQ(errorColour(1.5, 2.0), kYellow);
  EXPECT_EQ(errorColour(2.0, 2.0), kRed);
  EXPECT_EQ(errorColour(100.0, 2.0), kRed);
  EXPECT_EQ(errorColour(0.25, 2.0), 0x0080FFu);
}

TEST(ErrorColour, IsBlueWhereAllErrorsAreZero) {
  EXPECT_EQ(errorColour(0.0, 0.0), kBlue);
}

TEST(ErrorCloud, HoldsPointsErrorsAndColoursAsPclPacksThem) {
  const test::TemporaryDirectory directory;
  std::vector<Vector<3>> points;
  std::vector<double> errors;
  for (int i = 0; i < 200; ++i) {  // the 99 % quantile is 197
    points.emplace_back(i, -0.5 * i, 3);
    errors.push_back(i);
  }
  writeErrorCloud(directory.path() / "errors.pcd", points, errors);
  const PcdReader reader(directory.path() / "errors.pcd");
  ASSERT_EQ(reader.size(), points.size());
  ASSERT_EQ(reader.header().fields.size(), 5u);
  EXPECT_EQ(reader.header().fields[3].name, "error");
  EXPECT_EQ(reader.header().fields[4].name, "rgb");
  EXPECT_EQ(reader.header().fields[4].type, 'F');
  EXPECT_EQ(reader.header().fields[4].size, 4u);
  EXPECT_EQ(reader.header().viewpoint.translation, Eigen::Vector3d::Zero());
  const auto columns = reader.columns({{"x", 0}, {"y", 0}, {"error", 0}, {"rgb", 0}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(columns[0][i], points[i].x());
    EXPECT_EQ(columns[1][i], points[i].y());
    EXPECT_EQ(columns[2][i], errors[i]);
    const float packed = static_cast<float>(columns[3][i]);
    std::uint32_t colour = 0;
    std::memcpy(&colour, &packed, sizeof colour);
    EXPECT_EQ(colour, errorColour(errors[i], 197.0)) << "point " << i;
  }
}

TEST(ErrorCloud, LosesLittleFarFromTheOrigin) {
  const test::TemporaryDirectory directory;
  const Vector<3> far(636001.123, 848935.456, -406.789);
  writeErrorCloud(directory.path() / "far.pcd", {far, far + Vector<3>(700, 0, 0)}, {1.0, 2.0});
  const PcdReader reader(directory.path() / "far.pcd");
  const auto columns = reader.columns({{"x", 0}, {"y", 0}, {"z", 0}});
  const Vector<3> read = Vector<3>(columns[0][0], columns[1][0], columns[2][0]) + reader.header().viewpoint.translation;
  EXPECT_LT((read - far).cwiseAbs().maxCoeff(), 1e-4);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(std::fmod(reader.header().viewpoint.translation(axis), 1024.0), 0.0);
}

TEST(ErrorCloud, RefusesWhatDoesNotFitTogetherAndWritesNothing) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "errors.pcd";
  EXPECT_THROW(writeErrorCloud(path, {}, {}), std::invalid_argument);
  EXPECT_THROW(writeErrorCloud(path, {{0, 0, 0}}, {1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(writeErrorCloud(path, {{0, 0, 0}}, {std::nan("")}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(writeErrorCloud(directory.path() / "missing" / "errors.pcd", {{0, 0, 0}}, {1.0}), FileError);
}

}  // namespace
}  // namespace gaussmap
