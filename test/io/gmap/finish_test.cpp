// SPDX-License-Identifier: BSD-3-Clause
// Finished maps and their files.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "gaussmap/io/gmap/map_update.h"
#include "io/gmap/map_file_fixture.h"
#include "map/inherit_occupancy.h"

namespace gaussmap::test {
using namespace detail;

namespace {

namespace fs = std::filesystem;

class FinishedFile : public MapFile {
 protected:
  fs::path path() const { return directory_.path() / "map.gmap"; }
  template <int D>
  GaussianMap<D> savedFinished(const GaussianMap<D>& map, int level = 15) {
    save<D>(path(), map, {}, {true, level, 0, Precision::Finished});
    return load<D>(path());
  }
};

template <int D>
void expectClose(const GaussianMap<D>& exact, const GaussianMap<D>& finished) {
  for (int s = 0; s < exact.scales(); ++s) {
    EXPECT_EQ(finished.scale(s).keys, exact.scale(s).keys);
    EXPECT_EQ(finished.scale(s).parent, exact.scale(s).parent);
    EXPECT_TRUE(sameRanges<D>(exact, finished, s));
    EXPECT_TRUE(finished.scale(s).moments.empty());
    for (std::size_t i = 0; i < exact.gaussianCount(s); ++i) {
      const Gaussian<D> a = exact.localGaussian(i, s), b = finished.localGaussian(i, s);
      EXPECT_LT(klDivergence<D>(a, b), 0.05);
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(b.cov, a.cov);
      EXPECT_GE(std::sqrt(solver.eigenvalues().minCoeff()), 0.95);
      EXPECT_LE(std::sqrt(solver.eigenvalues().maxCoeff()), 1.05);
      const Matrix<D> precision = b.cov.inverse();
      for (int axis = 0; axis < D; ++axis)
        EXPECT_LE(std::abs(a.mean(axis) - b.mean(axis)) * std::sqrt(precision(axis, axis)), 1.0001 / 16.0);
      EXPECT_LE(std::abs(b.weight / a.weight - 1.0), 1.0 / 32.0);
      EXPECT_NEAR(exact.logOdds(i, s), finished.logOdds(i, s), 1.0 / 32.0);
    }
  }
}

TEST_F(FinishedFile, IsWithinTheStatedErrorOfTheMap) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = refined<3>(build<3>(randomCloud<3>(2000, 141), {0.05, ratio, 3, 0.0}));
    const GaussianMapOctree finished = savedFinished<3>(map);
    expectSameMap<3>(finished, finish<3>(map));
    expectClose<3>(map, finished);
    EXPECT_FALSE(finished.acceptsScans());
  }
  const GaussianMapQuadtree plane = refined<2>(build<2>(randomCloud<2>(2000, 142), {0.02, 4, 4, 0.0}));
  expectSameMap<2>(savedFinished<2>(plane), finish<2>(plane));
  expectClose<2>(plane, finish<2>(plane));
}

TEST_F(FinishedFile, KeepsOccupancies) {
  const GaussianMapOctree plain = smallMap();
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < plain.gaussianCount(0); ++i)
    log_odds.push_back(0.13f * static_cast<float>(i % 50) - 3.0f);
  const GaussianMapOctree map = withOccupancy<3>(plain, log_odds), finished = savedFinished<3>(map);
  expectSameMap<3>(finished, finish<3>(map));
  expectClose<3>(map, finished);
  EXPECT_TRUE(finished.hasOccupancy());
}

TEST_F(FinishedFile, TakesAtMost24BytesAGaussian) {
  const GaussianMapOctree map = refined<3>(build<3>(randomCloud<3>(200000, 143), {0.05, 5, 3, 0.0}));
  std::size_t gaussians = 0;
  for (int s = 0; s < 3; ++s) gaussians += map.gaussianCount(s);
  ASSERT_GT(gaussians, 5000u);
  savedFinished<3>(map, 3);
  EXPECT_LT(fs::file_size(path()), 24 * gaussians);
}

TEST_F(FinishedFile, LeavesOutFinerScales) {
  const GaussianMapOctree map = smallMap(), coarse = finish<3>(map, 1);
  EXPECT_EQ(coarse.cellCount(0), 0u);
  EXPECT_EQ(coarse.scale(1).keys, map.scale(1).keys);
  expectSameMap<3>(savedFinished<3>(coarse), coarse);
  EXPECT_THROW(finish<3>(map, 3), std::out_of_range);
  EXPECT_THROW(finish<3>(map, -1), std::out_of_range);
}

TEST_F(FinishedFile, HoldsMapsOfOnePointNothingAndFarAway) {
  for (const std::vector<Vector<3>>& points : std::vector<std::vector<Vector<3>>>{
           {{-0.05, 7.3, -1e-9}}, {}, {{1e7, -1e7, 0.3}, {1e7, -1e7, 0.31}}, std::vector<Vector<3>>(5000, {1, 2, 3})}) {
    const GaussianMapOctree map = build<3>(points, {0.1, 10, 3, 0.0});
    expectSameMap<3>(savedFinished<3>(map), finish<3>(map));
  }
  std::vector<Vector<3>> lattice;  // compresses to almost nothing
  for (int x = 0; x < 60; ++x)
    for (int y = 0; y < 60; ++y) lattice.emplace_back(x + 0.5, y + 0.5, 0.5);
  const GaussianMapOctree map = build<3>(lattice, {1.0, 10, 2, 0.0});
  expectSameMap<3>(savedFinished<3>(map, 19), finish<3>(map));
}

TEST_F(FinishedFile, SaysThatItIsFinalUntilItIsSavedExactly) {
  const GaussianMapOctree finished = savedFinished<3>(smallMap());
  ASSERT_EQ(loadMetadata(path()).count(kFinalEntry), 1u);
  EXPECT_NE(loadMetadata(path()).at(kFinalEntry).find("5 %"), std::string::npos);
  save(path(), finished, loadMetadata(path()), {true, 3, 0});
  EXPECT_EQ(loadMetadata(path()).count(kFinalEntry), 0u);
  expectSameMap<3>(load(path()), finished);
}

TEST_F(FinishedFile, TakesNoMorePoints) {
  savedFinished<3>(smallMap());
  expectComplaint(complaintOf([&] { updateMap<3>(path(), MomentGrid<3>(0.1)); }), path(), {"final"});
}

TEST_F(FinishedFile, HasTheSameBytesForAnyThreads) {
  std::vector<std::string> files;
  for (const int threads : {1, 2, 0}) {
    save(path(), smallMap(), {}, {true, 15, threads, Precision::Finished});
    files.push_back(contentsOf(path()));
  }
  for (const std::string& file : files) EXPECT_TRUE(file == files.front());
}

TEST_F(FinishedFile, WithBytesChangedIsTheSameOrRefused) {
  const GaussianMapOctree finished = savedFinished<3>(smallMap());
  const std::string good = contentsOf(path());
  Random random(144);
  int refused = 0;
  for (int round = 0; round < 1000; ++round) {
    directory_.write("changed.gmap", mutated(good, random));
    try {
      EXPECT_TRUE(sameMap<3>(load(directory_.path() / "changed.gmap"), finished)) << "round " << round;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace gaussmap::test
