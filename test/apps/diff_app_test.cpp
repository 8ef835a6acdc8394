// SPDX-License-Identifier: BSD-3-Clause
// gaussmap diff through the real program.
#include <array>
#include <memory>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::test {
namespace {

/// A floor, on it a box at x0 that fills 3 x 3 x 3 cells of 0.1 m with ten points each.
void writeFloorAndBox(const std::string& path, double x0) {
  std::vector<Vector<3>> points;
  for (int x = 0; x < 150; ++x)
    for (int y = 0; y < 150; ++y) points.emplace_back(0.02 * x + 0.01, 0.02 * y + 0.01, 0.05);
  for (int cell = 0; cell < 27; ++cell)
    for (int i = 0; i < 10; ++i)
      points.emplace_back(x0 + 0.1 * (cell % 3) + 0.009 * i + 0.005, 1.0 + 0.1 * (cell / 3 % 3) + 0.05,
                          1.0 + 0.1 * (cell / 9) + 0.05);
  writePcd(path, points);
}

class DiffApp : public AppTest {
 protected:
  void SetUp() override {
    for (const auto& [name, x0] : {std::pair("a", 0.5), std::pair("b", 2.0)}) {
      writeFloorAndBox(own(std::string(name) + ".pcd"), x0);
      succeed({"pcd2map", own(std::string(name) + ".pcd"), "-o", own(std::string(name) + ".gmap"), "--frame", "map",
               "--budget", "1"});
    }
  }
};

TEST_F(DiffApp, CountsAndLabelsWhatIsNewAndGone) {
  const Json said = Json::parse(succeed({"diff", own("a.gmap"), own("b.gmap"), "-o", own("d.pcd"), "--json"}));
  EXPECT_EQ(said["new"], 27);
  EXPECT_EQ(said["gone"], 27);
  EXPECT_EQ(said["changed"], 0);
  EXPECT_EQ(said["same"], 900);
  EXPECT_EQ(said["level"], 0.01);

  const PcdReader reader(own("d.pcd"));
  const auto columns = reader.columns({{"x", 0}, {"z", 0}, {"label", 0}, {"p_value", 0}, {"weight", 0}});
  ASSERT_EQ(reader.size(), 900u + 27u + 27u);
  std::array<int, 4> counts{};
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const double x = columns[0][i], label = columns[2][i];
    ++counts.at(static_cast<std::size_t>(label));
    ASSERT_EQ(label != 0.0, columns[1][i] > 0.5);  // what is off the floor
    if (label == 0.0) continue;
    ASSERT_EQ(label, x > 1.5 ? 1.0 : 2.0);
    ASSERT_LT(columns[3][i], 0.01);
    ASSERT_EQ(columns[4][i], 10.0);
  }
  EXPECT_EQ(counts, (std::array<int, 4>{900, 27, 27, 0}));
  const std::string text = succeed({"diff", own("a.gmap"), own("b.gmap")});
  EXPECT_NE(text.find("27 new, 27 gone, 0 changed, 900 the same"), std::string::npos) << text;
  EXPECT_EQ(Json::parse(succeed({"diff", own("a.gmap"), own("a.gmap"), "--json"}))["same"], 927);
}

TEST_F(DiffApp, RefusesWhatItCannotCompare) {
  succeed({"pcd2map", own("a.pcd"), "-o", own("c.gmap"), "--frame", "map", "--resolution", "0.2"});
  expectDataError("different grids", {"diff", own("a.gmap"), own("c.gmap")});
  expectUsageError("has the scales 0 to 2", {"diff", own("a.gmap"), own("b.gmap"), "--scale", "3"});
  expectUsageError("must end in .pcd", {"diff", own("a.gmap"), own("b.gmap"), "-o", own("d.ply")});
  expectUsageError("--level", {"diff", own("a.gmap"), own("b.gmap"), "--level", "0"});
}

}  // namespace
}  // namespace gaussmap::test
