// SPDX-License-Identifier: BSD-3-Clause
// Deleted clusters of planar maps: written to a file, read back, and restored.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "editing/restore_clusters.h"
#include "gaussmap/editing/crop.h"
#include "gaussmap/editing/diff_maps.h"
#include "gaussmap/editing/merge_maps.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "io/pcd/removed_pcd.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using namespace detail;
using test::randomCloud;

const MapOptions kPlanarGrid{0.1, 4, 3, 0.0};

bool isLeft(const Vector<2>& mean) {
  return mean.x() < 0.0;
}

/// The finest clusters of a map that lie on the left, as OnlineMapper would report them.
std::vector<RemovedCluster<2>> clustersOnTheLeft(const GaussianMap<2>& map) {
  std::vector<RemovedCluster<2>> removed;
  for (std::size_t i = 0; i < map.cellCount(0); ++i) {
    if (!isLeft(map.gaussian(i, 0).mean)) continue;
    removed.push_back({0, map.gaussian(i, 0), map.scale(0).keys[i], map.scale(0).moments[i], -0.5, {3, 9, 1, 4}, 12});
  }
  return removed;
}

TEST(PlanarRestore, UndoesADeletionFromItsFile) {
  const GaussianMap<2> whole = build<2>(randomCloud<2>(3000, 8), kPlanarGrid);
  const GaussianMap<2> right = crop<2>(whole, [](const Vector<2>& mean) { return !isLeft(mean); });
  const std::vector<RemovedCluster<2>> removed = clustersOnTheLeft(whole);
  ASSERT_GT(removed.size(), 10u);
  ASSERT_LT(right.cellCount(0), whole.cellCount(0));

  const test::TemporaryDirectory folder;
  const std::filesystem::path path = folder.path() / "removed.pcd";
  writeRemoved(path, removed);
  const std::vector<RemovedCluster<2>> read = readRemoved<2>(path);
  ASSERT_EQ(read.size(), removed.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].key, removed[i].key);
    EXPECT_EQ(read[i].moments, removed[i].moments);
    EXPECT_EQ(read[i].gaussian.mean, removed[i].gaussian.mean);
    EXPECT_EQ(read[i].gaussian.cov, removed[i].gaussian.cov);
    EXPECT_EQ(read[i].evidence.misses, 9u);
    EXPECT_EQ(read[i].scan, 12u);
  }
  for (const RemovedCluster<3>& one : readRemoved(path)) {  // in space: clusters in the plane z = 0
    EXPECT_EQ(one.gaussian.mean.z(), 0.0);
    EXPECT_GT(one.gaussian.cov(2, 2), 0.0);
    EXPECT_NEAR(one.moments.mean(0.1).z(), -0.05, 1e-15);
    EXPECT_NEAR(one.moments.covariance(0.1)(2, 2), 0.0, 1e-15);
    EXPECT_NEAR(one.moments.covariance(0.1)(0, 2), 0.0, 1e-15);
  }

  const RestoredMap<2> restored = restoreClusters<2>(right, read, [](const Vector<2>&) { return true; });
  EXPECT_EQ(restored.clusters, removed.size());
  EXPECT_EQ(double(restored.points), whole.weight(0) - right.weight(0));
  test::expectSameMap<2>(restored.map, whole);
  const RestoredMap<2> none = restoreClusters<2>(right, read, [](const Vector<2>&) { return false; });
  EXPECT_EQ(none.clusters, 0u);
  EXPECT_EQ(none.map.scale(0).keys, right.scale(0).keys);
}

TEST(PlanarRestore, RefusesClustersOfMapsInSpace) {
  RemovedCluster<3> one;
  one.gaussian = {{0.25, 0.25, 0.05}, 0.01 * Matrix<3>::Identity(), 1.0};
  one.key = {2, 2, 0};
  const test::TemporaryDirectory folder;
  writeRemoved(folder.path() / "space.pcd", std::vector<RemovedCluster<3>>{one});
  try {
    readRemoved<2>(folder.path() / "space.pcd");
    ADD_FAILURE() << "took a cluster above the plane";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("point 0 does not lie in the plane z = 0"), std::string::npos);
  }
}

TEST(PlanarEditing, PartsMergeToTheWholeAndDoNotDiffer) {
  const GaussianMap<2> whole = build<2>(randomCloud<2>(3000, 9), kPlanarGrid);
  const GaussianMap<2> left = crop<2>(whole, isLeft),
                       right = crop<2>(whole, [](const Vector<2>&mean) { return !isLeft(mean); });
  const GaussianMap<2> merged = mergeMaps(left, right);
  EXPECT_EQ(merged.scale(0).keys, whole.scale(0).keys);
  EXPECT_EQ(merged.scale(0).moments, whole.scale(0).moments);
  DiffOptions options;
  options.scale = 0;
  EXPECT_EQ(diffMaps(whole, merged, options).count(Change::None), whole.gaussianCount(0));
  EXPECT_GT(diffMaps(whole, right, options).count(Change::Gone), 0u);
}

}  // namespace
}  // namespace gaussmap
