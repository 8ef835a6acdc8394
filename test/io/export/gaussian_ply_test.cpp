// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/map_export.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "io/mesh/ply_vertices.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
namespace {

class GaussianPly : public testing::Test {
 protected:
  std::string write(const GaussianMap<3>& map, const GaussianPlyOptions& options) const {
    EXPECT_EQ(savePly(path(), map, options), options.scale ? map.gaussianCount(*options.scale) : leaves(map).size());
    return contentsOf(path());
  }
  std::filesystem::path path() const { return directory_.path() / "map.ply"; }

  TemporaryDirectory directory_;
  const GaussianMap<3> map_ = build<3>(randomCloud<3>(2000, 7), {0.25, 4, 2, 0.0});
};

/// R diag(exp(scale))^2 R' of splat i.
Matrix<3> covarianceOf(const PlyVertices& splats, std::size_t i) {
  const Eigen::Quaterniond rotation(splats.at("rot_0", i), splats.at("rot_1", i), splats.at("rot_2", i),
                                    splats.at("rot_3", i));
  const Vector<3> scales(std::exp(splats.at("scale_0", i)), std::exp(splats.at("scale_1", i)),
                         std::exp(splats.at("scale_2", i)));
  const Matrix<3> root = rotation.toRotationMatrix() * scales.asDiagonal();
  return root * root.transpose();
}

TEST_F(GaussianPly, SplatsHaveThePropertiesInTheOrderThatViewersExpect) {
  std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"};
  for (int i = 0; i < 45; ++i) names.push_back("f_rest_" + std::to_string(i));
  for (const char* const name : {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    names.emplace_back(name);
  const PlyVertices splats = plyVertices(write(map_, {PlyContent::Splats, PlyColour::Height, 1, 2.0}));
  EXPECT_EQ(splats.names, names);
  EXPECT_EQ(splats.count, map_.gaussianCount(1));
  EXPECT_EQ(splats.bytes_left, 0u);
}

TEST_F(GaussianPly, SplatsGiveBackMeanAndCovarianceOfEveryGaussian) {
  const PlyVertices splats = plyVertices(write(map_, {PlyContent::Splats, PlyColour::Height, 0, 2.0}));
  ASSERT_EQ(splats.count, map_.gaussianCount(0));
  ASSERT_GT(splats.count, 100u);
  for (std::size_t i = 0; i < splats.count; ++i) {
    const Gaussian<3> gaussian = map_.gaussian(i, 0);
    const Vector<3> mean(splats.at("x", i), splats.at("y", i), splats.at("z", i));
    EXPECT_LT((mean - gaussian.mean).norm(), 1e-5);
    const double length = std::hypot(std::hypot(splats.at("rot_0", i), splats.at("rot_1", i)),
                                     std::hypot(splats.at("rot_2", i), splats.at("rot_3", i)));
    EXPECT_NEAR(length, 1.0, 1e-6);
    EXPECT_LT((covarianceOf(splats, i) - gaussian.cov).norm(), 2e-6 * gaussian.cov.norm());
    const Vector<3> normal(splats.at("nx", i), splats.at("ny", i), splats.at("nz", i));
    EXPECT_NEAR(normal.norm(), 1.0, 1e-6);
    EXPECT_GE(normal.z(), -1e-6);
  }
}

TEST_F(GaussianPly, AKnownSplatHasTheLogarithmsOfItsDeviationsAndItsOccupancyAsOpacity) {
  MapScale<3> scale;
  scale.keys = {{0, 0, 0}};
  scale.gaussians = {{{1, 2, 3}, Vector<3>(4.0, 0.25, 1.0).asDiagonal(), 5.0}};
  scale.log_odds = {-1.5f};
  const GaussianMap<3> map({10.0, 2, 1, 0.0}, {scale});
  const PlyVertices splat = plyVertices(write(map, {PlyContent::Splats, PlyColour::Normal, 0, 2.0}));
  EXPECT_NEAR(splat.at("scale_0", 0), std::log(0.5), 1e-6);  // ascending
  EXPECT_NEAR(splat.at("scale_1", 0), std::log(1.0), 1e-6);
  EXPECT_NEAR(splat.at("scale_2", 0), std::log(2.0), 1e-6);
  EXPECT_EQ(splat.at("opacity", 0), -1.5);
  EXPECT_EQ(splat.at("f_rest_44", 0), 0.0);
  EXPECT_NEAR(splat.at("ny", 0), 1.0, 1e-6);
  const double red = 0.5 + 0.28209479177387814 * splat.at("f_dc_0", 0);
  EXPECT_NEAR(255.0 * red, 205.0, 0.01);  // what faces along y
  EXPECT_LT(covarianceOf(splat, 0)(0, 1), 1e-6);
}

TEST_F(GaussianPly, FarMapsAreWrittenAboutAnOriginThatTheHeaderNames) {
  std::vector<Vector<3>> points = randomCloud<3>(500, 3);
  for (Vector<3>& point : points) point += Vector<3>(1e7, -2e7, 30.0);
  const GaussianMap<3> map = build<3>(points, {0.25, 4, 2, 0.0});
  for (const PlyContent content : {PlyContent::Splats, PlyContent::Points, PlyContent::Ellipsoids}) {
    const PlyVertices ply = plyVertices(write(map, {content, PlyColour::Height, 0, 2.0}));
    ASSERT_EQ(ply.comments.size(), 2u);
    std::istringstream words(ply.comments[1]);
    std::string word;
    Vector<3> origin;
    words >> word >> origin.x() >> origin.y() >> origin.z();
    EXPECT_EQ(word, "origin");
    const std::size_t each = content == PlyContent::Ellipsoids ? 26 : 1;
    for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
      Vector<3> mean = Vector<3>::Zero();  // of an ellipsoid, the middle of its corners
      for (std::size_t k = i * each; k < (i + 1) * each; ++k)
        mean += Vector<3>(ply.at("x", k), ply.at("y", k), ply.at("z", k)) / static_cast<double>(each);
      EXPECT_LT((mean + origin - map.gaussian(i, 0).mean).norm(), 1e-3);
    }
  }
  EXPECT_EQ(plyVertices(write(map_, {PlyContent::Splats, PlyColour::Height, 0, 2.0})).comments.size(), 1u);
}

TEST_F(GaussianPly, TheCornersOfAnEllipsoidLieAtSigmaStandardDeviations) {
  const std::string bytes = write(map_, {PlyContent::Ellipsoids, PlyColour::Height, 1, 3.0});
  const PlyVertices ply = plyVertices(bytes);
  const TriangleMesh mesh = readPly(path());  // every viewer of meshes
  ASSERT_EQ(mesh.vertices.size(), 26 * map_.gaussianCount(1));
  ASSERT_EQ(mesh.triangles.size(), 48 * map_.gaussianCount(1));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    EXPECT_NEAR(mahalanobisSquared<3>(mesh.vertices[i], map_.gaussian(i / 26, 1)), 9.0, 0.01);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Gaussian<3> gaussian = map_.gaussian(i / 48, 1);
    const auto corner = [&](std::size_t k) -> Vector<3> { return mesh.vertices[mesh.triangles[i][k]]; };
    const Vector<3> out = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    EXPECT_EQ(mesh.triangles[i][0] / 26, i / 48);
    EXPECT_GE(out.dot(corner(0) - gaussian.mean), 0.0);  // seen from outside
  }
}

TEST_F(GaussianPly, PointsHaveNormalsColoursAndWeights) {
  const PlyVertices ply = plyVertices(write(map_, {PlyContent::Points, PlyColour::Height, 1, 2.0}));
  EXPECT_EQ(ply.names, (std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "weight"}));
  double weight = 0.0;
  for (std::size_t i = 0; i < ply.count; ++i) weight += ply.at("weight", i);
  EXPECT_EQ(weight, 2000.0);
}

TEST_F(GaussianPly, WithoutAScaleItIsTheMapAtItsFinest) {
  EXPECT_EQ(plyVertices(write(map_, {PlyContent::Points, PlyColour::Height, {}, 2.0})).count, map_.gaussianCount(0));
}

TEST_F(GaussianPly, AnEmptyMapIsAFileWithoutVertices) {
  const GaussianMap<3> empty({1.0, 2, 1, 0.0});
  for (const PlyContent content : {PlyContent::Splats, PlyContent::Points, PlyContent::Ellipsoids})
    EXPECT_EQ(plyVertices(write(empty, {content, PlyColour::Height, {}, 2.0})).count, 0u);
}

TEST_F(GaussianPly, RefusesWhatCannotBeAndLeavesNoFile) {
  EXPECT_THROW(savePly(path(), map_, {PlyContent::Splats, PlyColour::Height, 2, 2.0}), std::out_of_range);
  for (const double sigma : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_THROW(savePly(path(), map_, {PlyContent::Ellipsoids, PlyColour::Height, 0, sigma}), std::invalid_argument);
  EXPECT_THROW(savePly(directory_.path() / "no" / "map.ply", map_), FileError);
  EXPECT_TRUE(std::filesystem::is_empty(directory_.path()));
}

}  // namespace
}  // namespace gaussmap::test
