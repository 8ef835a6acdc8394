// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/moving_cells.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Cells on a line along x, `points` in the middle of each, and what scans said about them.
class Line {
 public:
  explicit Line(double resolution = 0.2) : resolution_(resolution) {}

  void add(int x, int points, const Evidence& evidence) {
    const Vector<3> middle((x + 0.5) * resolution_, 0.5 * resolution_, 0.5 * resolution_);
    points_.insert(points_.end(), static_cast<std::size_t>(points), middle);
    cells_.emplace_back(x, evidence);
  }

  GaussianMap<3> map() const { return build<3>(points_, MapOptions{resolution_, 6, 3, 0.0}); }

  std::vector<Evidence> evidence() const {
    const GaussianMap<3> cells = map();
    std::vector<Evidence> evidence(cells.cellCount(0));
    for (const auto& [x, said] : cells_) evidence[*cells.find({x, 0, 0}, 0)] = said;
    return evidence;
  }

  /// The cells that moved, as their x.
  std::vector<int> moving(const MovingCellOptions& options = {}) const {
    const GaussianMap<3> cells = map();
    const std::vector<bool> found = findMovingCells(cells, evidence(), options);
    EXPECT_EQ(found.size(), cells.cellCount(0));
    std::vector<int> moving;
    for (std::size_t cell = 0; cell < found.size(); ++cell)
      if (found[cell]) moving.push_back(cells.scale(0).keys[cell][0]);
    std::sort(moving.begin(), moving.end());
    return moving;
  }

 private:
  double resolution_;
  std::vector<Vector<3>> points_;
  std::vector<std::pair<int, Evidence>> cells_;
};

using Xs = std::vector<int>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Evidence kGone{1, 5, 4, 4};   // hit by scan 4, then five scans passed
constexpr Evidence kStill{9, 1, 0, 9};  // hit by nearly all
constexpr Evidence kBlind{1, 0, 4, 4};  // hit by scan 4, never seen again

TEST(FindMovingCells, FreesWhatMoreScansPassedThanHit) {
  Line line;
  line.add(0, 50, kGone);
  line.add(10, 50, kStill);
  line.add(20, 50, {1, 2, 0, 0});  // 0.85 - 0.8
  line.add(30, 50, {1, 3, 0, 0});  // 0.85 - 1.2
  line.add(40, 50, {0, 5, 0, 0});  // in the map, but none of these scans hit it
  EXPECT_EQ(line.moving(), (Xs{0, 30}));
  MovingCellOptions options;
  options.occupancy.miss = 0.5;
  EXPECT_EQ(line.moving(options), (Xs{0, 20, 30}));
  options.occupancy.hit = 3.0;
  EXPECT_EQ(line.moving(options), Xs{});
}

TEST(FindMovingCells, RestoresGroupsOfAFewPoints) {
  Line line;
  line.add(0, 9, kGone);
  line.add(10, 10, kGone);
  line.add(20, 5, kGone);  // beside each other
  line.add(21, 5, kGone);
  line.add(30, 5, kGone);  // a cell between them
  line.add(32, 5, kGone);
  EXPECT_EQ(line.moving(), (Xs{10, 20, 21}));
  MovingCellOptions options;
  options.link = 0.4;
  EXPECT_EQ(line.moving(options), (Xs{10, 20, 21, 30, 32}));
  options.min_points = 11.0;
  EXPECT_EQ(line.moving(options), Xs{});
  options.min_points = 0.0;
  EXPECT_EQ(line.moving(options), (Xs{0, 10, 20, 21, 30, 32}));
}

TEST(FindMovingCells, DoesNotLinkGroupsByCellsThatStay) {
  Line line;
  line.add(0, 5, kGone);
  line.add(1, 50, kStill);
  line.add(2, 5, kGone);
  EXPECT_EQ(line.moving(), Xs{});
}

TEST(FindMovingCells, GrowsIntoWhatWasSeenOnlyTogetherWithTheObject) {
  Line line;
  const Evidence object{3, 20, 4, 8};
  line.add(0, 50, object);
  line.add(1, 1, {2, 0, 5, 6});   // while it was there
  line.add(-1, 1, {1, 0, 3, 3});  // before it came
  line.add(10, 50, object);
  line.add(11, 1, {2, 0, 4, 9});  // after it had gone
  line.add(9, 1, {2, 1, 4, 8});   // also passed once
  line.add(20, 50, object);
  line.add(22, 1, {2, 0, 5, 6});  // not beside it
  line.add(30, 50, object);
  line.add(31, 1, {0, 0, 0, 0});  // not seen at all
  line.add(40, 50, kStill);
  line.add(41, 1, {1, 0, 5, 5});  // beside nothing that moved
  EXPECT_EQ(line.moving(), (Xs{0, 1, 9, 10, 20, 30}));
}

TEST(FindMovingCells, DoesNotGrowFromTheCellsOfNoScan) {  // scan 0 is the first hit of what was never hit, too
  Line line;
  line.add(0, 50, {1, 5, 0, 0});
  line.add(1, 50, Evidence{});
  EXPECT_EQ(line.moving(), Xs{0});
}

TEST(FindMovingCells, GrowsOnlyAsFarAsAnObjectReaches) {
  Line line;
  line.add(0, 50, kGone);
  for (int x = 1; x < 8; ++x) line.add(x, 1, kBlind);
  EXPECT_EQ(line.moving(), (Xs{0, 1, 2}));  // 0.2 and 0.4 m from the freed cell
  MovingCellOptions options;
  options.reach = 1.1;
  EXPECT_EQ(line.moving(options), (Xs{0, 1, 2, 3, 4, 5}));
  options.reach = 0.0;
  EXPECT_EQ(line.moving(options), Xs{0});
  options.reach = std::numeric_limits<double>::infinity();
  EXPECT_EQ(line.moving(options), (Xs{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(FindMovingCells, CountsInMetresNotInCells) {
  Line line(0.1);
  line.add(0, 50, kGone);
  line.add(2, 1, kBlind);  // 0.2 m on
  line.add(4, 1, kBlind);
  line.add(6, 1, kBlind);  // 0.6 m from the freed cell
  line.add(13, 5, kGone);
  line.add(15, 5, kGone);
  EXPECT_EQ(line.moving(), (Xs{0, 2, 4, 13, 15}));
}

TEST(FindMovingCells, TakesEmptyMapsAndRefusesEvidenceOfAnotherMap) {
  EXPECT_TRUE(findMovingCells(GaussianMap<3>{}, {}).empty());
  Line line;
  line.add(0, 50, kGone);
  try {
    findMovingCells(line.map(), std::vector<Evidence>(3));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "3 entries of evidence for a map with 1 finest cells, expected one per cell");
  }
}

TEST(FindMovingCells, NamesTheOptionThatIsNotUsable) {
  const auto refusal = [](auto change) -> std::string {
    MovingCellOptions options;
    change(options);
    try {
      findMovingCells(GaussianMap<3>(MapOptions{0.5, 6, 3, 0.0}), {}, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([](auto&) {}), "");
  EXPECT_EQ(refusal([](auto& o) { o.occupancy.hit = 0.0; }), "hit = 0: must be positive");
  EXPECT_EQ(refusal([](auto& o) { o.occupancy.miss = -1.0; }), "miss = -1: must be positive");
  EXPECT_EQ(refusal([](auto& o) { o.min_points = kNaN; }), "min_points = nan: must not be negative");
  EXPECT_EQ(refusal([](auto& o) { o.link = -0.1; }), "link = -0.1: must be 0 to 1000 cells");
  EXPECT_EQ(refusal([](auto& o) { o.link = 500.5; }), "link = 500.5: must be 0 to 1000 cells");
  EXPECT_EQ(refusal([](auto& o) { o.reach = kNaN; }), "reach = nan: must not be negative");
}

}  // namespace
}  // namespace gaussmap
