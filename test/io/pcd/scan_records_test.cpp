// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/scan_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace gaussmap {
namespace {

/// Two points with values.
class TwoPoints : public ScanReader {
 public:
  explicit TwoPoints(double x) : x_(x) {}
  std::size_t size() const override { return 2; }
  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first == 0 ? 2 : 0;
    for (std::size_t i = 0; i < block.size; ++i) {
      block.coordinate[0][i] = x_;
      block.coordinate[1][i] = 2.0 + static_cast<double>(i);
      block.coordinate[2][i] = std::nan("");
    }
  }
  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const auto& [name, values] : values_) names.push_back(name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override { return values_.at(name); }

  std::map<std::string, std::vector<double>> values_;

 private:
  double x_;
};

std::string typesOf(const ScanReader& reader) {
  std::string text;
  for (const PcdField& field : detail::recordsOf(reader, Pose()).fields)
    text += field.name + ":" + field.type + std::to_string(field.size) + " ";
  return text;
}

TEST(ScanRecords, HaveCoordinatesAsFloatsIfNothingIsLost) {
  EXPECT_EQ(typesOf(TwoPoints(0.5)), "x:F4 y:F4 z:F4 ");
  EXPECT_EQ(typesOf(TwoPoints(0.1)), "x:F8 y:F8 z:F8 ");
}

TEST(ScanRecords, HaveTypesThatFollowFromTheMeaningOfAValue) {
  TwoPoints points(0.5);
  points.values_ = {{"intensity", {1.0, 2.0}},
                    {"range", {0.1, 2.0}},
                    {"rgb", {0.0, 16777215.0}},
                    {"ring", {3.0, 4.0}},
                    {"time", {0.5, 1.0}}};
  EXPECT_EQ(typesOf(points), "x:F4 y:F4 z:F4 intensity:F4 range:F8 rgb:U4 ring:U4 time:F8 ");
  points.values_ = {{"ring", {std::nan(""), 4.0}}};  // no return has no ring
  EXPECT_EQ(typesOf(points), "x:F4 y:F4 z:F4 ring:F4 ");
}

}  // namespace
}  // namespace gaussmap
