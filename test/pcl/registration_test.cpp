// SPDX-License-Identifier: BSD-3-Clause
// PCL's own templates: g++ 12 warns of what it has inlined into them.
#pragma GCC diagnostic ignored "-Warray-bounds"
#include "gaussmap/pcl/registration.h"

#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/registration/icp.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "io/files/temporary_directory.h"
#include "pcl/scan_cloud.h"
#include "simulation/simulation.h"

namespace gaussmap {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Two scans of the hall, 1 m or so apart.
struct Hall {
  SimulatedScan target, source;
  Eigen::Matrix4d truth;  // source to target

  Hall() {
    Simulation hall = makeSimulation(WorldName::Hall);
    std::get<LidarOptions>(hall.sensor).columns = 300;
    target = simulateScan(hall, 0);
    source = simulateScan(hall, 1);
    truth = matrixOf(target.pose).inverse() * matrixOf(source.pose);
  }
};
const Hall& hall() {
  static const Hall scans;
  return scans;
}

template <typename Scalar>
void expectNear(const Eigen::Matrix<Scalar, 4, 4>& found, const Eigen::Matrix4d& truth) {
  const Eigen::Matrix4d off = found.template cast<double>() * truth.inverse();
  EXPECT_LT((off.topRightCorner<3, 1>()).norm(), 0.03);
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(off.topLeftCorner<3, 3>())).angle(), 0.004);
}

/// What a program that knows only the base class does.
template <typename PointT>
void alignBy(pcl::Registration<PointT, PointT>& registration, pcl::PointCloud<PointT>& output) {
  registration.setInputTarget(cloudOf<PointT>(hall().target));
  registration.setInputSource(cloudOf<PointT>(hall().source));
  registration.align(output);
}

template <typename PointT>
class RegistrationOf : public testing::Test {};
using PointTypes =
    testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal, pcl::PointXYZINormal>;
TYPED_TEST_SUITE(RegistrationOf, PointTypes, );  // clang asks for the comma

TYPED_TEST(RegistrationOf, PointsFindsThePoseThroughTheBaseClass) {
  GaussianMapRegistration<TypeParam, TypeParam> ours;
  pcl::PointCloud<TypeParam> output;
  alignBy<TypeParam>(ours, output);
  EXPECT_TRUE(ours.hasConverged());
  expectNear(ours.getFinalTransformation(), hall().truth);
  ASSERT_EQ(output.size(), hall().source.points.size());
  const Eigen::Vector4f there = ours.getFinalTransformation() * hall().source.points[5].cast<float>().homogeneous();
  ASSERT_TRUE(there.allFinite());
  EXPECT_LT((output[5].getVector3fMap() - there.head<3>()).norm(), 1e-4f);
}

TEST(GaussianMapRegistration, GivesTheFitnessScoreThatIcpGivesForTheSamePose) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours;
  pcl::PointCloud<pcl::PointXYZ> output;
  auto target = cloudOf<pcl::PointXYZ>(hall().target), source = cloudOf<pcl::PointXYZ>(hall().source);
  for (auto& cloud : {target, source})  // PCL's own class may not be asked for NaN
    cloud->erase(std::remove_if(cloud->begin(), cloud->end(), [](const auto& p) { return !std::isfinite(p.x); }),
                 cloud->end());
  ours.setInputTarget(target);
  ours.setInputSource(source);
  ours.align(output);
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;  // stays where it starts
  icp.setMaximumIterations(1);
  icp.setMaxCorrespondenceDistance(1e-9);
  icp.setInputTarget(target);
  icp.setInputSource(source);
  pcl::console::VERBOSITY_LEVEL before = pcl::console::getVerbosityLevel();
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  icp.align(output, ours.getFinalTransformation());
  pcl::console::setVerbosityLevel(before);
  ASSERT_EQ(icp.getFinalTransformation(), ours.getFinalTransformation());
  EXPECT_EQ(ours.getFitnessScore(), icp.getFitnessScore());
  EXPECT_EQ(ours.getFitnessScore(0.1), icp.getFitnessScore(0.1));
}

TEST(GaussianMapRegistration, MakesNoTreeUnlessTheScoreIsAsked) {
  LazyKdTree<pcl::PointXYZ> lazy;
  pcl::search::KdTree<pcl::PointXYZ> plain;
  auto cloud = cloudOf<pcl::PointXYZ>(hall().target);
  pcl::Indices a, b;
  std::vector<float> near, far;
  EXPECT_EQ(lazy.nearestKSearch(pcl::PointXYZ(0, 0, 0), 1, a, near), 0);
  EXPECT_EQ(near[0], std::numeric_limits<float>::infinity());
  lazy.setCloud(cloud);
  plain.setInputCloud(cloud);
  for (const pcl::PointXYZ& point : {pcl::PointXYZ(1, 2, 0), pcl::PointXYZ(-3, 0, 1)}) {
    EXPECT_EQ(lazy.nearestKSearch(point, 3, a, near), plain.nearestKSearch(point, 3, b, far));
    EXPECT_EQ(a, b);
    EXPECT_EQ(lazy.radiusSearch(point, 0.7, a, near), plain.radiusSearch(point, 0.7, b, far));
    EXPECT_EQ(near, far);
  }
  EXPECT_EQ(lazy.nearestKSearch(pcl::PointXYZ(kNan, 0, 0), 1, a, near), 0);
  EXPECT_EQ(lazy.radiusSearch(pcl::PointXYZ(kNan, 0, 0), 1.0, a, near), 0);
}

TEST(GaussianMapRegistration, LeavesOutPointsThatAreNoneAndKeepsThePlaceInTheOutput) {
  auto source = cloudOf<pcl::PointXYZ>(hall().source), target = cloudOf<pcl::PointXYZ>(hall().target);
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours;
  for (std::size_t i = 0; i < source->size(); i += 7) (*source)[i].x = (*target)[i].y = kNan;
  ours.setInputTarget(target);
  ours.setInputSource(source);
  pcl::PointCloud<pcl::PointXYZ> output;
  ours.align(output);
  EXPECT_TRUE(ours.hasConverged());
  expectNear(ours.getFinalTransformation(), hall().truth);
  EXPECT_EQ(output.size(), source->size());
  EXPECT_FALSE(std::isfinite(output[7].x));
  EXPECT_LT(ours.getFitnessScore(), 1.0);
}

/// What both classes do with the same calls: the shape and the header of the output.
template <typename Registration>
pcl::PointCloud<pcl::PointXYZ> organisedOutput(bool some) {
  auto source = cloudOf<pcl::PointXYZ>(hall().source);
  for (auto& point : *source)
    if (!std::isfinite(point.x)) point = pcl::PointXYZ(1, 1, 1);
  source->is_dense = true;
  source->width = 300;
  source->height = static_cast<std::uint32_t>(source->size()) / 300;
  source->header.frame_id = "lidar";
  Registration registration;
  registration.setInputTarget(source);
  registration.setInputSource(source);
  if (some) registration.setIndices(pcl::IndicesPtr(new pcl::Indices{5, 900, 17, 4000, 2000, 1000, 3000, 2500}));
  pcl::PointCloud<pcl::PointXYZ> output;
  registration.align(output);
  EXPECT_EQ(registration.getFinalTransformation().hasNaN(), false);
  return output;
}

TEST(GaussianMapRegistration, KeepsAnOrganisedCloudAsIcpDoes) {
  const auto ours = organisedOutput<GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ>>(false);
  const auto icp = organisedOutput<pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>(false);
  EXPECT_EQ(ours.width, icp.width);
  EXPECT_EQ(ours.height, icp.height);
  EXPECT_EQ(ours.is_dense, icp.is_dense);
  EXPECT_EQ(ours.header.frame_id, icp.header.frame_id);
  for (std::size_t i = 0; i < ours.size(); i += 100)
    EXPECT_LT((ours[i].getVector3fMap() - icp[i].getVector3fMap()).norm(), 0.02f);
}

TEST(GaussianMapRegistration, AlignsOnlyTheIndices) {
  auto source = cloudOf<pcl::PointXYZ>(hall().source), spoilt = cloudOf<pcl::PointXYZ>(hall().source);
  pcl::IndicesPtr every(new pcl::Indices);
  for (std::size_t i = 0; i < source->size(); ++i) {
    if (i % 3 == 0)
      every->push_back(static_cast<pcl::index_t>(i));
    else
      (*spoilt)[i].getVector3fMap() *= 0.3f;  // would lead astray
  }
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> a, b;
  pcl::PointCloud<pcl::PointXYZ> of_a, of_b;
  for (auto* ours : {&a, &b}) {
    ours->setInputTarget(cloudOf<pcl::PointXYZ>(hall().target));
    ours->setInputSource(ours == &a ? source : spoilt);
    ours->setIndices(every);
    ours->align(ours == &a ? of_a : of_b);
  }
  EXPECT_EQ(a.getFinalTransformation(), b.getFinalTransformation());
  EXPECT_EQ(of_a.size(), every->size());
  expectNear(a.getFinalTransformation(), hall().truth);
}

TEST(GaussianMapRegistration, TurnsNormalsWithTheirPoints) {
  auto source = cloudOf<pcl::PointNormal>(hall().source);
  for (auto& point : *source) point.normal_x = 1.0f;
  GaussianMapRegistration<pcl::PointNormal, pcl::PointNormal> ours;
  ours.setInputTarget(cloudOf<pcl::PointNormal>(hall().target));
  ours.setInputSource(source);
  pcl::PointCloud<pcl::PointNormal> output;
  Eigen::Matrix4f guess = hall().truth.cast<float>();
  guess.topLeftCorner<3, 3>() = guess.topLeftCorner<3, 3>() * Eigen::AngleAxisf(0.1f, Eigen::Vector3f::UnitZ());
  ours.align(output, guess);
  const Eigen::Vector3f turned = ours.getFinalTransformation().col(0).head<3>();
  for (std::size_t i = 0; i < output.size(); i += 50)
    if (std::isfinite(output[i].x)) {
      EXPECT_LT((output[i].getNormalVector3fMap() - turned).norm(), 1e-5f);
    }
}

TEST(GaussianMapRegistration, WorksInDoubles) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ, double> ours;
  ours.setInputTarget(cloudOf<pcl::PointXYZ>(hall().target));
  ours.setInputSource(cloudOf<pcl::PointXYZ>(hall().source));
  pcl::PointCloud<pcl::PointXYZ> output;
  ours.align(output, Eigen::Matrix4d::Identity());
  expectNear(ours.getFinalTransformation(), hall().truth);
  EXPECT_EQ(ours.getFinalTransformation(), matrixOf(ours.result().pose));
  EXPECT_EQ(ours.getPoseCovariance(), ours.result().covariance);
  EXPECT_GT(ours.getPoseCovariance()(0, 0), 0.0);
  EXPECT_FALSE(ours.isDegenerate());
}

TEST(GaussianMapRegistration, KeepsTheMapTillTheTargetChanges) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours;
  EXPECT_EQ(ours.getTargetMap(), nullptr);
  const auto target = cloudOf<pcl::PointXYZ>(hall().target);
  ours.setInputTarget(target);
  ours.setInputSource(cloudOf<pcl::PointXYZ>(hall().source));
  const auto map = ours.getTargetMap();
  EXPECT_EQ(map->options().resolution, GaussianMapRegistrationOptions().map.resolution);
  pcl::PointCloud<pcl::PointXYZ> output;
  ours.align(output);
  ours.align(output);
  EXPECT_EQ(ours.getTargetMap(), map);
  ours.setInputTarget(target);  // its points may have changed
  EXPECT_NE(ours.getTargetMap(), map);
  ours.setResolution(0.3);
  EXPECT_EQ(ours.getTargetMap()->options().resolution, 0.3);
}

TEST(GaussianMapRegistration, AlignsWithAMapThatWasMadeBefore) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> by_cloud, by_map, by_file;
  by_cloud.setInputTarget(cloudOf<pcl::PointXYZ>(hall().target));
  const auto map = by_cloud.getTargetMap();
  test::TemporaryDirectory directory;
  const auto path = directory.path() / "hall.gmap";
  save(path, *map);
  ASSERT_TRUE(by_map.setTargetMap(map));
  ASSERT_TRUE(by_file.setTargetMap(path));
  pcl::PointCloud<pcl::PointXYZ> output;
  for (auto* ours : {&by_cloud, &by_map, &by_file}) {
    ours->setInputSource(cloudOf<pcl::PointXYZ>(hall().source));
    ours->align(output);
    EXPECT_TRUE(ours->hasConverged());
    EXPECT_EQ(ours->getFinalTransformation(), by_cloud.getFinalTransformation());
    EXPECT_LT(ours->getFitnessScore(), 1.0);
  }
  EXPECT_EQ(by_map.getInputTarget()->size(), map->gaussianCount(0));
  by_map.setResolution(0.3);
  EXPECT_EQ(by_map.getTargetMap(), map);  // it is not rebuilt
}

TEST(GaussianMapRegistration, StopsAfterTheIterationsThatItIsGiven) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours;
  EXPECT_EQ(ours.getMaximumIterations(), RegistrationOptions().max_iterations);
  EXPECT_NEAR(ours.getTransformationEpsilon(), std::pow(RegistrationOptions().translation, 2), 1e-15);
  ours.setMaximumIterations(1);
  pcl::PointCloud<pcl::PointXYZ> output;
  alignBy<pcl::PointXYZ>(ours, output);
  EXPECT_FALSE(ours.hasConverged());
  EXPECT_LE(ours.result().iterations, 8);  // four scales, two steps each
  ours.setTransformationEpsilon(1e4);
  ours.setTransformationRotationEpsilon(0.5);
  ours.align(output);
  EXPECT_TRUE(ours.hasConverged());  // any step is small enough
}

/// Errors are printed, not thrown, and the guess stands.
class GaussianMapRegistrationErrors : public testing::Test {
 protected:
  void SetUp() override { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }
  void TearDown() override { pcl::console::setVerbosityLevel(pcl::console::L_INFO); }

  pcl::PointCloud<pcl::PointXYZ>::Ptr empty_ = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  pcl::PointCloud<pcl::PointXYZ> output_;
};

template <typename Registration>
void expectNothingOfNothing(const pcl::PointCloud<pcl::PointXYZ>::Ptr& empty) {
  Registration registration;
  pcl::PointCloud<pcl::PointXYZ> output;
  registration.align(output);  // neither source nor target
  EXPECT_TRUE(output.empty());
  EXPECT_FALSE(registration.hasConverged());
  registration.setInputTarget(empty);
  registration.setInputSource(empty);
  EXPECT_EQ(registration.getInputTarget(), nullptr);
  EXPECT_EQ(registration.getInputSource(), nullptr);
  registration.align(output);
  EXPECT_TRUE(output.empty());
  EXPECT_FALSE(registration.hasConverged());
}

TEST_F(GaussianMapRegistrationErrors, EmptyCloudsAreRefusedAsByIcp) {
  expectNothingOfNothing<GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ>>(empty_);
  expectNothingOfNothing<pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ>>(empty_);
}

TEST_F(GaussianMapRegistrationErrors, MapsThatAreNoneAreRefused) {
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours;
  test::TemporaryDirectory directory;
  directory.write("text.gmap", "no map");
  EXPECT_FALSE(ours.setTargetMap(directory.path() / "text.gmap"));
  EXPECT_FALSE(ours.setTargetMap(directory.path() / "none.gmap"));
  EXPECT_FALSE(ours.setTargetMap(std::make_shared<const GaussianMapOctree>()));
  EXPECT_FALSE(ours.setTargetMap(GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ>::MapConstPtr()));
  ours.setInputTarget(nullptr);
  EXPECT_EQ(ours.getInputTarget(), nullptr);
}

TEST_F(GaussianMapRegistrationErrors, TheGuessStandsWhereNothingCanBeDone) {
  const auto expectGuess = [&](auto&& spoil) {
    GaussianMapRegistrationOptions options;
    auto target = cloudOf<pcl::PointXYZ>(hall().target), source = cloudOf<pcl::PointXYZ>(hall().source);
    Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
    guess(0, 3) = 0.5f;
    spoil(options, *target, *source, guess);
    GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> ours(options);
    ours.setInputTarget(target);
    ours.setInputSource(source);
    ours.align(output_, guess);
    EXPECT_FALSE(ours.hasConverged());
    EXPECT_TRUE(ours.isDegenerate());
    EXPECT_TRUE(ours.getPoseCovariance().isZero());
    EXPECT_TRUE(ours.getFinalTransformation() == guess || guess.hasNaN());
    EXPECT_EQ(output_.size(), source->size());
  };
  const auto spoilAll = [](pcl::PointCloud<pcl::PointXYZ>& cloud, float value) {
    for (auto& point : cloud) point.x = value;
  };
  expectGuess([&](auto&, auto& target, auto&, auto&) { spoilAll(target, kNan); });
  expectGuess([&](auto&, auto&, auto& source, auto&) { spoilAll(source, kNan); });
  expectGuess([&](auto&, auto& target, auto&, auto&) { spoilAll(target, 1e30f); });
  expectGuess([&](auto&, auto&, auto& source, auto&) { spoilAll(source, 1e30f); });
  expectGuess([&](auto&, auto&, auto& source, auto&) { spoilAll(source, 1e6f); });  // meets nothing
  expectGuess([&](auto&, auto&, auto&, auto& guess) { guess(1, 3) = kNan; });
  expectGuess([&](auto&, auto&, auto&, auto& guess) { guess.template topLeftCorner<3, 3>() *= 2.0f; });
  expectGuess([&](auto&, auto&, auto&, auto& guess) { guess(2, 2) = -1.0f; });  // a mirror
  expectGuess([&](auto& options, auto&, auto&, auto&) { options.map.resolution = -1.0; });
  expectGuess([&](auto& options, auto&, auto&, auto&) { options.registration.kernel = 0.0; });
}

// The examples of the README.

/// Localises a scan against a saved map.
std::optional<Eigen::Matrix4f> localise(const std::string& map_file, const pcl::PointCloud<pcl::PointXYZ>::Ptr& scan,
                                        const Eigen::Matrix4f& guess) {
  gaussmap::GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  if (!registration.setTargetMap(map_file)) return std::nullopt;
  registration.setInputSource(scan);
  pcl::PointCloud<pcl::PointXYZ> aligned;
  registration.align(aligned, guess);
  if (!registration.hasConverged() || registration.isDegenerate()) return std::nullopt;
  return registration.getFinalTransformation();
}

TEST(ReadmeExample, LocalisesAScanAgainstASavedMap) {
  test::TemporaryDirectory directory;
  const auto path = directory.path() / "hall.gmap";
  GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> maker;
  maker.setInputTarget(cloudOf<pcl::PointXYZ>(hall().target));
  save(path, *maker.getTargetMap());
  const auto found = localise(path.string(), cloudOf<pcl::PointXYZ>(hall().source), Eigen::Matrix4f::Identity());
  ASSERT_TRUE(found);
  expectNear(*found, hall().truth);
  EXPECT_FALSE(localise("none.gmap", cloudOf<pcl::PointXYZ>(hall().source), Eigen::Matrix4f::Identity()));
}

/// A pipeline that was written for pcl::NormalDistributionsTransform: only the type is another.
pcl::PointCloud<pcl::PointXYZ> together(const std::vector<pcl::PointCloud<pcl::PointXYZ>::Ptr>& scans) {
  // pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> registration;
  gaussmap::GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setResolution(0.5);
  pcl::PointCloud<pcl::PointXYZ> all = *scans.front(), aligned;
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
  for (std::size_t i = 1; i < scans.size(); ++i) {
    registration.setInputTarget(scans[i - 1]);
    registration.setInputSource(scans[i]);
    registration.align(aligned);
    pose = pose * registration.getFinalTransformation();
    pcl::transformPointCloud(*scans[i], aligned, pose);
    all += aligned;
  }
  return all;
}

TEST(ReadmeExample, PutsScansTogether) {
  const auto first = cloudOf<pcl::PointXYZ>(hall().target), second = cloudOf<pcl::PointXYZ>(hall().source);
  const pcl::PointCloud<pcl::PointXYZ> all = together({first, second});
  ASSERT_EQ(all.size(), first->size() + second->size());
  const Eigen::Vector4d there = hall().truth * hall().source.points[5].homogeneous();
  EXPECT_LT((all[first->size() + 5].getVector3fMap().cast<double>() - there.head<3>()).norm(), 0.1);
}

}  // namespace
}  // namespace gaussmap
