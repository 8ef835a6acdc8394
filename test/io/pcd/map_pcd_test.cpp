// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/map_pcd.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/temporary_directory.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using test::randomCloud;
using test::TemporaryDirectory;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no FileError";
  return "";
}

GaussianMapOctree refined(const GaussianMapOctree& map) {
  return refine<3>(map, PerCell{2.5}).map;
}

std::vector<Vector<3>> shifted(std::vector<Vector<3>> points, const Vector<3>& shift) {
  for (Vector<3>& point : points) point += shift;
  return points;
}

/// Equal but for what floats lose: 2^-24 of a weight, of a covariance's norm, and `mean_tolerance` [m] of a mean.
void expectSameButForFloats(const GaussianMapOctree& got, const GaussianMapOctree& map, double mean_tolerance) {
  EXPECT_EQ(got.options().resolution, map.options().resolution);
  EXPECT_EQ(got.options().ratio, map.options().ratio);
  ASSERT_EQ(got.scales(), map.scales());
  for (int s = 0; s < map.scales(); ++s) {
    EXPECT_EQ(got.scale(s).keys, map.scale(s).keys);
    ASSERT_EQ(got.gaussianCount(s), map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      const Gaussian<3> expected = map.localGaussian(i, s), found = got.localGaussian(i, s);
      EXPECT_EQ(got.cellOf(i, s), map.cellOf(i, s));
      EXPECT_NEAR(found.weight, expected.weight, 1e-7 * expected.weight);
      EXPECT_LT((found.mean - expected.mean).lpNorm<Eigen::Infinity>(), mean_tolerance);
      EXPECT_LT((found.cov - expected.cov).norm(), 1e-5 * expected.cov.norm());
      EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(found.cov).info(), Eigen::Success);
    }
  }
}

class MapPcd : public testing::Test {
 protected:
  fs::path saved(const GaussianMapOctree& map, const ExportOptions& options = {}) {
    const fs::path path = directory_.path() / ("map" + std::to_string(next_++) + ".pcd");
    savePcd(path, map, options);
    return path;
  }

  TemporaryDirectory directory_;
  int next_ = 0;
};

TEST_F(MapPcd, GivesBackTheMapButForFloats) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 61), {0.1, ratio, 3, 0.0});
    expectSameButForFloats(loadPcd(saved(map)), map, 5e-7);
    const GaussianMapOctree fine = refined(map);
    const GaussianMapOctree got = loadPcd(saved(fine));
    expectSameButForFloats(got, fine, 5e-7);
    EXPECT_FALSE(got.acceptsScans());
  }
}

TEST_F(MapPcd, KnowsResolutionsThatFloatsOnlyApproach) {
  for (const double resolution : {0.1, 0.3, 0.002, 0.123456, 17.0, 1.0 / 1024.0}) {
    const GaussianMapOctree map = build<3>(randomCloud<3>(300, 62), {resolution, 10, 2, 0.0});
    EXPECT_EQ(loadPcd(saved(map)).options().resolution, resolution);
  }
}

TEST_F(MapPcd, LinksOneClusterToTheOneThereIs) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(2000, 63), {0.1, 4, 3, 0.0});
  const GaussianMapOctree got = loadPcd(saved(map));
  for (int s = 0; s < 2; ++s) EXPECT_EQ(got.scale(s).parent, map.scale(s).parent);
}

TEST_F(MapPcd, LinksEveryGaussianToTheNearestClusterAbove) {
  const GaussianMapOctree map = refined(build<3>(randomCloud<3>(2000, 64), {0.1, 10, 3, 0.0}));
  const GaussianMapOctree got = loadPcd(saved(map));
  for (int s = 0; s < 2; ++s) {
    for (std::size_t i = 0; i < got.gaussianCount(s); ++i) {
      const CellKey<3> above = got.grid().ancestor(got.scale(s).keys[got.cellOf(i, s)], s, s + 1);
      const IndexRange clusters = got.gaussiansOf(got.find(above, s + 1).value(), s + 1);
      ASSERT_GE(got.parentOf(i, s), clusters.first);
      ASSERT_LT(got.parentOf(i, s), clusters.last);
      const double chosen = klDivergence<3>(got.gaussian(i, s), got.gaussian(got.parentOf(i, s), s + 1));
      for (std::size_t other = clusters.first; other < clusters.last; ++other)
        EXPECT_LE(chosen, klDivergence<3>(got.gaussian(i, s), got.gaussian(other, s + 1)) * (1.0 + 1e-6) + 1e-6);
    }
  }
}

TEST_F(MapPcd, OfOneScaleIsAMapOfThatScaleAlone) {
  const GaussianMapOctree map = refined(build<3>(randomCloud<3>(3000, 65), {0.1, 5, 3, 0.0}));
  for (int s = 0; s < 3; ++s) {
    ExportOptions options;
    options.scale = s;
    const fs::path path = saved(map, options);
    EXPECT_EQ(PcdReader(path).size(), map.gaussianCount(s));
    EXPECT_EQ(PcdReader(path).column("scale").front(), s);
    const GaussianMapOctree got = loadPcd(path);
    ASSERT_EQ(got.scales(), 1);
    EXPECT_NEAR(got.options().resolution, map.grid().side(s), 1e-12);
    ASSERT_EQ(got.gaussianCount(0), map.gaussianCount(s));
    EXPECT_NEAR(got.weight(0), 3000.0, 1e-3);
  }
  ExportOptions none;
  none.scale = 3;
  EXPECT_THROW(saved(map, none), std::out_of_range);
  none.scale = -1;
  EXPECT_THROW(saved(map, none), std::out_of_range);
}

TEST_F(MapPcd, FarAwayKeepsAThousandthOfACellThroughItsViewpoint) {
  const Vector<3> far(1e7, -1e7, 3.3e6);
  const GaussianMapOctree map = refined(build<3>(shifted(randomCloud<3>(2000, 66), far), {0.1, 10, 3, 0.0}));
  const fs::path path = saved(map);
  const Eigen::Vector3d origin = PcdReader(path).header().viewpoint.translation;
  EXPECT_LT((origin - far).lpNorm<Eigen::Infinity>(), 1024.0);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(std::fmod(origin(axis), 1024.0), 0.0);
  expectSameButForFloats(loadPcd(path), map, 1e-4);
}

TEST_F(MapPcd, NearTheOriginHasNoViewpoint) {
  const fs::path path = saved(build<3>(shifted(randomCloud<3>(500, 67), {500, 0, 0}), {0.1, 10, 3, 0.0}));
  EXPECT_EQ(PcdReader(path).header().viewpoint.translation.norm(), 0.0);
}

TEST_F(MapPcd, RepairsCovariancesThatFloatsHaveSpoilt) {  // plates of 90 m, 1 mm thick
  Random random(68);
  std::vector<Vector<3>> points;
  for (int plate = 0; plate < 30; ++plate) {
    const double slope = random.uniform() - 0.5, tilt = random.uniform() - 0.5;
    for (int i = 0; i < 1000; ++i) {
      const double a = 90.0 * random.uniform() - 45.0, b = 90.0 * random.uniform() - 45.0;
      points.emplace_back(100.0 * plate + 50.0 + a, 50.0 + b, 50.0 + slope * a + tilt * b);
    }
  }
  const GaussianMapOctree map = build<3>(points, {0.1, 10, 4, 0.001});
  const GaussianRecords records = toRecords(map);
  int spoilt = 0;
  for (const GaussianRecord& record : records.records) {
    const auto& c = record.covariance;
    Eigen::Matrix3d cov;
    cov << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    spoilt += Eigen::LLT<Eigen::Matrix3d>(cov).info() != Eigen::Success;
  }
  EXPECT_GT(spoilt, 0);  // else there is nothing to repair
  expectSameButForFloats(fromRecords(records), map, 1e-4);
}

TEST_F(MapPcd, CanBeReadBackWithManyScalesAndMuchNoise) {  // 2^20 finest cells along a coarsest one
  const GaussianMapOctree map = build<3>(randomCloud<3>(300, 69), {0.1, 2, 21, 0.1});
  EXPECT_EQ(loadPcd(saved(map)).scales(), 21);
}

TEST_F(MapPcd, KeepsAnExistingFileUnlessToldOtherwise) {
  const fs::path path = directory_.write("mine.pcd", "mine");
  const GaussianMapOctree map = build<3>(randomCloud<3>(100, 70), {});
  EXPECT_THROW(savePcd(path, map), FileError);
  EXPECT_EQ(fs::file_size(path), 4u);
  ExportOptions options;
  options.overwrite = true;
  savePcd(path, map, options);
  EXPECT_EQ(loadPcd(path).cellCount(0), map.cellCount(0));
}

TEST_F(MapPcd, OfNothingIsNoMap) {
  EXPECT_NE(messageOf([&] { loadPcd(saved(GaussianMapOctree())); }).find("no Gaussian"), std::string::npos);
}

// ---- other clouds ---------------------------------------------------------------------------------------------------

/// Four Gaussians: one cell of 1 m and the three of 0.5 m in it that are occupied.
GaussianRecords goodRecords() {
  return toRecords(build<3>({{0.2, 0.2, 0.2}, {0.7, 0.2, 0.2}, {0.71, 0.22, 0.2}, {0.7, 0.8, 0.9}}, {0.5, 2, 2, 0.0}));
}

TEST(GaussianRecords, AreTakenIfNothingIsWrongWithThem) {
  ASSERT_EQ(goodRecords().records.size(), 4u);
  EXPECT_NO_THROW(fromRecords(goodRecords()));
}

TEST(GaussianRecords, AreRefusedIfAnythingIsWrongWithThem) {
  const auto expectRefused = [](const char* why, auto&& spoil) {
    for (std::size_t i = 0; i < 4; ++i) {
      GaussianRecords records = goodRecords();
      spoil(records.records[i]);
      try {
        fromRecords(records);
        ADD_FAILURE() << "record " << i << " taken though: " << why;
      } catch (const std::invalid_argument& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
      }
    }
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    expectRefused("NaN mean", [&](GaussianRecord& r) { r.mean[axis] = kNaN; });
    expectRefused("infinite mean", [&](GaussianRecord& r) { r.mean[axis] = -kInfinity; });
    expectRefused("mean outside", [&](GaussianRecord& r) { r.mean[axis] += 2.0f; });
    expectRefused("another cell", [&](GaussianRecord& r) { r.cell[axis] += 3; });
    expectRefused("the farthest cell",
                  [&](GaussianRecord& r) { r.cell[axis] = std::numeric_limits<std::int32_t>::min(); });
  }
  for (std::size_t element = 0; element < 6; ++element) {
    expectRefused("NaN covariance", [&](GaussianRecord& r) { r.covariance[element] = kNaN; });
    expectRefused("infinite covariance", [&](GaussianRecord& r) { r.covariance[element] = kInfinity; });
  }
  expectRefused("negative variance", [](GaussianRecord& r) { r.covariance[3] = -0.01f; });
  expectRefused("no extent", [](GaussianRecord& r) { r.covariance = {}; });
  expectRefused("correlation above 1",
                [](GaussianRecord& r) { r.covariance[1] = 2.0f * r.covariance[0] + r.covariance[3]; });
  for (const float weight : {0.0f, -1.0f, kNaN, kInfinity})
    expectRefused("weight", [&](GaussianRecord& r) { r.weight = weight; });
  for (const float scale : {1e9f, -1.0f, 0.5f, 63.0f, 64.0f, 2.0f, kNaN, kInfinity, -kInfinity})
    expectRefused("scale", [&](GaussianRecord& r) { r.scale = scale; });
  for (const float side : {0.0f, -0.5f, 0.51f, 1e30f, 1e-44f, kNaN, kInfinity})
    expectRefused("cell side", [&](GaussianRecord& r) { r.cell_side = side; });
}

TEST(GaussianRecords, AreRefusedIfAllSidesAreWrong) {
  for (const float side : {0.0f, -0.5f, kNaN, kInfinity}) {
    GaussianRecords records = goodRecords();
    for (GaussianRecord& record : records.records) record.cell_side = side;
    EXPECT_THROW(fromRecords(records), std::invalid_argument) << side;
  }
}

TEST(GaussianRecords, AreRefusedWithoutAParent) {
  GaussianRecords records = goodRecords();
  records.records.erase(records.records.begin());  // coarsest first
  EXPECT_NO_THROW(fromRecords(records));           // one scale alone is a map
  records = goodRecords();
  records.records.resize(1);
  EXPECT_NO_THROW(fromRecords(records));
  const GaussianRecords two = toRecords(build<3>({{0.2, 0.2, 0.2}, {5.2, 0.2, 0.2}}, {0.5, 2, 2, 0.0}));
  ASSERT_EQ(two.records.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    GaussianRecords three = two;
    three.records.erase(three.records.begin() + static_cast<std::ptrdiff_t>(i));
    if (i < 2)
      EXPECT_THROW(fromRecords(three), std::invalid_argument) << i;
    else
      EXPECT_TRUE(fromRecords(three).isCompressed()) << i;  // a coarse cell may stand alone
  }
  EXPECT_THROW(fromRecords({}), std::invalid_argument);
}

TEST(GaussianRecords, AreRefusedWithAnOriginThatIsNone) {
  for (const double value : {static_cast<double>(kNaN), static_cast<double>(kInfinity), 1e300, 1.0}) {
    GaussianRecords records = goodRecords();
    records.origin.y() = value;
    EXPECT_THROW(fromRecords(records), std::invalid_argument) << value;
  }
}

TEST_F(MapPcd, OfOtherCloudsIsRefused) {
  const fs::path points = directory_.path() / "points.pcd";
  writePcd(points, randomCloud<3>(100, 1));
  EXPECT_NE(messageOf([&] { loadPcd(points); }).find("points, not Gaussians"), std::string::npos);
  EXPECT_THROW(loadPcd(directory_.path() / "missing.pcd"), FileError);
  EXPECT_THROW(loadPcd(directory_.write("text.pcd", "hello")), FileError);
  EXPECT_THROW(loadPcd(directory_.write("empty.pcd", "")), FileError);
  EXPECT_THROW(loadPcd(directory_.path()), FileError);
}

/// Writes goodRecords() with some fields left out or of another kind, and with another VIEWPOINT.
fs::path writeRecords(const TemporaryDirectory& directory, const std::string& without, std::size_t elements = 6,
                      const Pose& viewpoint = {}, double cell_shift = 0.0) {
  static const GaussianRecords records = goodRecords();
  static std::vector<double> cells;
  cells.clear();
  for (const GaussianRecord& r : records.records) cells.push_back(r.cell[0] + cell_shift);
  const GaussianRecord& first = records.records.front();
  constexpr std::size_t kStride = sizeof(GaussianRecord);
  std::vector<PcdOutput> fields = {pcdOutput("x", &first.mean[0], 1, kStride),
                                   pcdOutput("y", &first.mean[1], 1, kStride),
                                   pcdOutput("z", &first.mean[2], 1, kStride),
                                   pcdOutput("covariance", first.covariance.data(), elements, kStride),
                                   pcdOutput("weight", &first.weight, 1, kStride),
                                   pcdOutput("occupancy", &first.occupancy, 1, kStride),
                                   pcdOutput("scale", &first.scale, 1, kStride),
                                   pcdOutput("cell_side", &first.cell_side, 1, kStride),
                                   pcdOutput("cell_z", &first.cell[2], 1, kStride),
                                   pcdOutput("cell_y", &first.cell[1], 1, kStride),
                                   pcdOutput("cell_x", cells.data())};
  fields.erase(std::remove_if(fields.begin(), fields.end(), [&](const PcdOutput& f) { return f.name == without; }),
               fields.end());
  const fs::path path = directory.path() / "records.pcd";
  writePcd(path, records.records.size(), fields, viewpoint);
  return path;
}

TEST_F(MapPcd, MayHaveItsFieldsInAnyOrderAndKind) {
  EXPECT_NO_THROW(loadPcd(writeRecords(directory_, "none")));
}

TEST_F(MapPcd, NeedsAllItsFields) {
  for (const char* const field :
       {"covariance", "weight", "occupancy", "scale", "cell_side", "cell_x", "cell_y", "cell_z"}) {
    const std::string message = messageOf([&] { loadPcd(writeRecords(directory_, field)); });
    EXPECT_NE(message.find(field), std::string::npos) << message;
  }
  EXPECT_THROW(loadPcd(writeRecords(directory_, "none", 3)), FileError);
}

TEST_F(MapPcd, NeedsWholeCells) {
  EXPECT_THROW(loadPcd(writeRecords(directory_, "none", 6, {}, 0.5)), FileError);
  EXPECT_THROW(loadPcd(writeRecords(directory_, "none", 6, {}, 1e10)), FileError);
  EXPECT_THROW(loadPcd(writeRecords(directory_, "none", 6, {}, kNaN)), FileError);
}

TEST_F(MapPcd, IsNotTurned) {  // cells cannot be
  Pose pose;
  pose.rotation = Pose::Rotation(0.0, 0.0, 0.0, 1.0);
  EXPECT_NE(messageOf([&] { loadPcd(writeRecords(directory_, "none", 6, pose)); }).find("VIEWPOINT"),
            std::string::npos);
}

// ---- which is which -------------------------------------------------------------------------------------------------

TEST_F(MapPcd, IsToldFromOtherFiles) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(500, 71), {});
  const fs::path pcd = saved(map), gmap = directory_.path() / "map.gmap", points = directory_.path() / "points.pcd";
  save(gmap, map, {{"who", "me"}});
  writePcd(points, randomCloud<3>(100, 1));
  EXPECT_TRUE(isGmap(gmap));
  EXPECT_TRUE(isMap(gmap));
  EXPECT_FALSE(isGmap(pcd));
  EXPECT_TRUE(isMap(pcd));
  const fs::path covariance_first = directory_.write(
      "ascii.pcd",
      "#\n# by hand\nVERSION .7\nFIELDS covariance x y z\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 6 1 1 1\nWIDTH 0\n"
      "HEIGHT 1\nPOINTS 0\nDATA ascii\n");
  EXPECT_TRUE(isMap(covariance_first));
  for (const fs::path& path :
       {points, directory_.write("text", "SQLite? no\nFIELDS covariance "), directory_.write("empty", ""),
        directory_.path() / "missing", directory_.path(), fs::path()}) {
    EXPECT_FALSE(isGmap(path)) << path;
    EXPECT_FALSE(isMap(path)) << path;
    EXPECT_THROW(loadAny(path), FileError) << path;
  }

  MapMetadata metadata;
  EXPECT_EQ(loadAny(gmap, &metadata).cellCount(0), map.cellCount(0));
  EXPECT_EQ(metadata, (MapMetadata{{"who", "me"}}));
  EXPECT_EQ(loadAny(gmap).cellCount(0), map.cellCount(0));
  EXPECT_EQ(loadAny(pcd, &metadata).cellCount(0), map.cellCount(0));
  const fs::path misnamed = directory_.path() / "pcd.gmap";
  fs::copy_file(pcd, misnamed);
  EXPECT_EQ(loadAny(misnamed).cellCount(0), map.cellCount(0));
  const std::string message = messageOf([&] { loadAny(directory_.write("text.gmap", "hello")); });
  EXPECT_NE(message.find(".gmap"), std::string::npos) << message;
}

}  // namespace
}  // namespace gaussmap
