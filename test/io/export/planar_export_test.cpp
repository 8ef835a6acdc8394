// SPDX-License-Identifier: BSD-3-Clause
// Exports of planar maps: the files of the map at z = 0.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "gaussmap/io/export/map_export.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "map/in_space.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

GaussianMap<2> planarExample() {
  return refine<2>(build<2>(test::randomCloud<2>(800, 3), {0.1, 4, 3, 0.0})).map;
}

TEST(PlanarExport, WritesTheFilesOfTheMapInSpace) {
  const test::TemporaryDirectory folder;
  const std::filesystem::path flat = folder.path() / "flat", space = folder.path() / "space";
  const GaussianMap<2> map = planarExample();
  const GaussianMap<3> lifted = detail::inSpace(map);
  EXPECT_EQ(savePly(flat, map), map.gaussianCount(0));
  savePly(space, lifted);
  EXPECT_EQ(test::contentsOf(flat), test::contentsOf(space));
  EXPECT_EQ(saveVtp(flat, map, 1), map.gaussianCount(1));
  saveVtp(space, lifted, 1);
  EXPECT_EQ(test::contentsOf(flat), test::contentsOf(space));
  savePcd(flat, map, {std::nullopt, true});
  savePcd(space, lifted, {std::nullopt, true});
  EXPECT_EQ(test::contentsOf(flat), test::contentsOf(space));
}

TEST(PlanarExport, HasHeightZeroInEveryRowOfTheTable) {
  const test::TemporaryDirectory folder;
  const GaussianMap<2> map = planarExample();
  const std::size_t rows = saveCsv(folder.path() / "map.csv", map);
  std::ifstream file(folder.path() / "map.csv");
  std::string line;
  std::getline(file, line);
  std::size_t count = 0;
  for (; std::getline(file, line); ++count) {
    std::istringstream cells(line);
    std::string cell;
    for (int column = 0; std::getline(cells, cell, ','); ++column)
      if (column == 4 || column == 7 || column == 10 || column == 12) {  // cell_z, z, cov_xz, cov_yz
        EXPECT_EQ(cell, "0") << line;
      }
  }
  EXPECT_EQ(count, rows);
  EXPECT_EQ(rows, map.gaussianCount(0) + map.gaussianCount(1) + map.gaussianCount(2));
}

TEST(PlanarExport, OfAPcdFileIsReadAsAMapInSpace) {
  const test::TemporaryDirectory folder;
  const GaussianMap<2> map = planarExample();
  savePcd(folder.path() / "map.pcd", map);
  const GaussianMap<3> read = loadPcd(folder.path() / "map.pcd");
  ASSERT_EQ(read.scales(), 3);
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(read.gaussianCount(s), map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      EXPECT_EQ(read.gaussian(i, s).mean.z(), 0.0);
      EXPECT_LT((read.gaussian(i, s).mean.head<2>() - map.gaussian(i, s).mean).norm(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace gaussmap
