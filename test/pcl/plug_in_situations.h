// SPDX-License-Identifier: BSD-3-Clause
// What PCL's own classes do in situations that users meet, and that the classes of gaussmap do the same. A source lists
// the pairs of classes (plug_in_pairs.h) and the point types.
#pragma once

#include "pcl/plug_in_pairs.h"

namespace gaussmap::test {

template <typename Pair>
class PlugIn : public testing::Test {
 protected:
  using Point = typename Pair::Point;
  using Cloud = pcl::PointCloud<Point>;

  /// Calls check(outcome, is_ours) for the class of gaussmap and for that of PCL.
  template <typename Check>
  static void withBoth(const Input<Point>& input, const Check& check) {
    check(Pair::ours(input), true);
    check(Pair::ofPcl(input), false);
  }

  static void expectSame(const Outcome& a, const Outcome& b) {
    EXPECT_EQ(a.count, b.count);
    EXPECT_EQ(a.converged, b.converged);
    EXPECT_LT((a.motion - b.motion).norm(), 1e-3f);
    ASSERT_EQ(a.values.size(), b.values.size());
    for (std::size_t i = 0; i < a.values.size(); ++i)
      EXPECT_TRUE(a.values[i].isApprox(b.values[i], 1e-3f) || (a.values[i].hasNaN() && b.values[i].hasNaN())) << i;
  }

  /// Returns the cloud with every seventh point replaced by NaN, and the other points as a list.
  static std::pair<Input<Point>, Input<Point>> withNanAndWithout() {
    const auto with = roomCloud<Point>(), without = pcl::make_shared<Cloud>();
    for (std::size_t i = 0; i < with->size(); ++i) {
      if (i % 7 == 3)
        (*with)[i].x = (*with)[i].y = (*with)[i].z = std::numeric_limits<float>::quiet_NaN();
      else
        without->push_back((*with)[i]);
    }
    with->is_dense = false;
    without->header = with->header;
    return {{with, nullptr}, {without, nullptr}};
  }

  static Outcome finiteOnly(Outcome outcome) {
    std::vector<Eigen::Vector3f> values;
    for (const Eigen::Vector3f& value : outcome.values)
      if (value.allFinite()) values.push_back(value);
    if (!outcome.values.empty()) outcome.count = values.size();
    outcome.values = std::move(values);
    return outcome;
  }
};
TYPED_TEST_SUITE_P(PlugIn);

TYPED_TEST_P(PlugIn, HasAResultForACloud) {
  this->withBoth({roomCloud<typename TypeParam::Point>(), nullptr}, [](const Outcome& outcome, bool is_ours) {
    EXPECT_GT(outcome.count, 100u) << is_ours;
    EXPECT_TRUE(outcome.converged) << is_ours;
    // The search of PCL in organised clouds complains of lidars: "not from a projective device".
    if (is_ours) {
      EXPECT_EQ(outcome.printed, "");
    }
  });
}

TYPED_TEST_P(PlugIn, HasNoResultWithoutACloud) {
  this->withBoth({nullptr, nullptr}, [](const Outcome& outcome, bool is_ours) {
    EXPECT_EQ(outcome.count, 0u) << is_ours;
    if (is_ours) {
      EXPECT_NE(outcome.printed, "");
    }
  });
}

TYPED_TEST_P(PlugIn, HasNoResultForAnEmptyCloud) {
  const auto empty = pcl::make_shared<pcl::PointCloud<typename TypeParam::Point>>();
  this->withBoth({empty, nullptr}, [](const Outcome& outcome, bool is_ours) {
    EXPECT_EQ(outcome.count, 0u) << is_ours;
    EXPECT_EQ(std::size_t{outcome.width} * outcome.height, 0u) << is_ours;
  });
}

TYPED_TEST_P(PlugIn, TakesOnlySelectedPoints) {
  const auto cloud = roomCloud<typename TypeParam::Point>();
  const auto indices = pcl::make_shared<pcl::Indices>();
  const auto part = pcl::make_shared<pcl::PointCloud<typename TypeParam::Point>>();
  for (std::size_t i = 0; i < cloud->size(); i += 2) {
    indices->push_back(static_cast<int>(i));
    part->push_back((*cloud)[i]);
  }
  part->header = cloud->header;
  Input<typename TypeParam::Point> selected{cloud, indices}, whole{part, nullptr};
  if constexpr (std::is_same_v<TypeParam, Normals<typename TypeParam::Point>>) {
    // The neighbours come from the whole cloud, so the normals are those of the whole cloud at these points.
    const auto every_second = [](Outcome outcome) {
      std::vector<Eigen::Vector3f> values;
      for (std::size_t i = 0; i < outcome.values.size(); i += 2) values.push_back(outcome.values[i]);
      outcome.values = std::move(values);
      outcome.count = outcome.values.size();
      return outcome;
    };
    this->expectSame(TypeParam::ours(selected), every_second(TypeParam::ours({cloud, nullptr})));
    this->expectSame(TypeParam::ofPcl(selected), every_second(TypeParam::ofPcl({cloud, nullptr})));
  } else {
    this->expectSame(TypeParam::ours(selected), TypeParam::ours(whole));
    if constexpr (TypeParam::kPclTakesIndices) this->expectSame(TypeParam::ofPcl(selected), TypeParam::ofPcl(whole));
  }
}

TYPED_TEST_P(PlugIn, IgnoresNan) {
  const auto [with, without] = this->withNanAndWithout();
  this->expectSame(this->finiteOnly(TypeParam::ours(with)), TypeParam::ours(without));
  if constexpr (TypeParam::kPclTakesNan)
    this->expectSame(this->finiteOnly(TypeParam::ofPcl(with)), TypeParam::ofPcl(without));
}

TYPED_TEST_P(PlugIn, HasNoResultForACloudOfNan) {
  auto cloud = roomCloud<typename TypeParam::Point>();
  for (auto& point : *cloud) point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
  cloud->is_dense = false;
  const Outcome ours = TypeParam::ours({cloud, nullptr});
  EXPECT_EQ(this->finiteOnly(ours).count, 0u);
}

TYPED_TEST_P(PlugIn, MakesRowsAsPclDoes) {
  const Input<typename TypeParam::Point> organised{roomCloud<typename TypeParam::Point>(), nullptr};
  const Outcome ours = TypeParam::ours(organised), of_pcl = TypeParam::ofPcl(organised);
  EXPECT_EQ(ours.height, of_pcl.height);
  EXPECT_EQ(ours.is_dense, of_pcl.is_dense);
  if constexpr (TypeParam::kKeepsRows) {
    EXPECT_EQ(ours.width, 180u);
    EXPECT_EQ(ours.height, 25u);
  }
}

TYPED_TEST_P(PlugIn, CopiesTheHeaderAsPclDoes) {
  const Input<typename TypeParam::Point> input{roomCloud<typename TypeParam::Point>(), nullptr};
  EXPECT_EQ(TypeParam::ours(input).frame_id, TypeParam::ofPcl(input).frame_id);
}

TYPED_TEST_P(PlugIn, LeavesTheInputAsItIs) {
  const auto cloud = roomCloud<typename TypeParam::Point>(), before = roomCloud<typename TypeParam::Point>();
  TypeParam::ours({cloud, nullptr});
  ASSERT_EQ(cloud->size(), before->size());
  for (std::size_t i = 0; i < cloud->size(); ++i)
    EXPECT_EQ((*cloud)[i].getVector3fMap(), (*before)[i].getVector3fMap());
}

REGISTER_TYPED_TEST_SUITE_P(PlugIn, HasAResultForACloud, HasNoResultWithoutACloud, HasNoResultForAnEmptyCloud,
                            TakesOnlySelectedPoints, IgnoresNan, HasNoResultForACloudOfNan, MakesRowsAsPclDoes,
                            CopiesTheHeaderAsPclDoes, LeavesTheInputAsItIs);

}  // namespace gaussmap::test
