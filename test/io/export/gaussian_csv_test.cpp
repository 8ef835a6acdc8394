// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <sstream>

#include "gaussmap/io/export/map_export.h"
#include "gaussmap/mapping/build.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "map/inherit_occupancy.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
using namespace detail;

namespace {

using Row = std::vector<double>;

std::vector<Row> rowsOf(const std::string& text, std::string* names) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, *names);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(GaussianCsv, GivesBackEveryNumberOfTheMapToTheLastBitAlsoFarAway) {
  std::vector<Vector<3>> points = randomCloud<3>(1000, 11);
  for (Vector<3>& point : points) point += Vector<3>(1e7, -1e7, 0.0);
  GaussianMap<3> map = build<3>(points, {0.25, 4, 3, 0.0});
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) log_odds.push_back(0.1f * static_cast<float>(i % 50));
  map = withOccupancy<3>(map, log_odds);
  const TemporaryDirectory directory;
  const std::size_t count = saveCsv(directory.path() / "map.csv", map);
  std::string names;
  const std::vector<Row> rows = rowsOf(contentsOf(directory.path() / "map.csv"), &names);
  EXPECT_EQ(names,
            "scale,cell_side,cell_x,cell_y,cell_z,x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz,weight,log_odds");
  ASSERT_EQ(rows.size(), count);
  std::size_t row = 0;
  for (int s = 2; s >= 0; --s)
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i, ++row) {
      const Gaussian<3> g = map.gaussian(i, s);
      const CellKey<3> key = map.scale(s).keys[map.cellOf(i, s)];
      const Row expected = {double(s),   map.grid().side(s), double(key[0]), double(key[1]), double(key[2]),
                            g.mean.x(),  g.mean.y(),         g.mean.z(),     g.cov(0, 0),    g.cov(0, 1),
                            g.cov(0, 2), g.cov(1, 1),        g.cov(1, 2),    g.cov(2, 2),    g.weight};
      ASSERT_EQ(rows[row].size(), 16u);
      EXPECT_EQ(Row(rows[row].begin(), rows[row].end() - 1), expected);
      EXPECT_EQ(static_cast<float>(rows[row].back()), map.logOdds(i, s));
    }
  EXPECT_EQ(row, count);
}

TEST(GaussianCsv, CanBeOneScaleAndRefusesOneThatIsNotThere) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(300, 5), {0.25, 4, 2, 0.0});
  const TemporaryDirectory directory;
  EXPECT_EQ(saveCsv(directory.path() / "map.csv", map, 1), map.gaussianCount(1));
  std::string names;
  for (const Row& row : rowsOf(contentsOf(directory.path() / "map.csv"), &names)) EXPECT_EQ(row[0], 1.0);
  EXPECT_THROW(saveCsv(directory.path() / "b.csv", map, 2), std::out_of_range);
  EXPECT_THROW(saveVtp(directory.path() / "b.vtp", map, -1), std::out_of_range);
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "b.csv"));
}

}  // namespace
}  // namespace gaussmap::test
