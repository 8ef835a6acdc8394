// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/utility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace gaussmap {
namespace {

SegmentGoals goals(double sigma, double length, double misfit = 0.0, double x = 0.0) {
  SegmentGoals goals;
  goals.normal_variance = sigma * sigma;
  goals.length = length;
  goals.misfit = misfit;
  goals.start = {x, 0.0};
  goals.end = {x + length, 0.0};
  return goals;
}

TEST(ViewpointInvariantUtility, VotesAsEquation4Says) {
  const ViewpointInvariantUtility utility({0.1, 1.0, 0.25});  // merges up to a variance of .0025, sigma .05
  const SegmentGoals any;
  EXPECT_GT(utility.split(goals(0.1001, 1.0), any, any), utility.nothing(any));
  EXPECT_LT(utility.split(goals(0.0999, 1.0), any, any), utility.nothing(any));
  EXPECT_LT(utility.split(goals(0.2, 0.99), any, any), utility.nothing(any));
  EXPECT_GT(utility.merge(any, any, goals(0.0499, 9.0)), utility.nothing(any));
  EXPECT_LT(utility.merge(any, any, goals(0.0501, 9.0)), utility.nothing(any));
}

TEST(ViewpointDependentUtility, SplitsShorterSegmentsInTheField) {
  ViewpointDependentOptions options;
  options.far = {0.1, 3.0, 0.25};
  options.scale = 0.5;
  options.radius = 2.0;
  ViewpointDependentUtility utility(options);
  const SegmentGoals any;
  utility.observe({0.0, 1.0});
  EXPECT_GT(utility.split(goals(0.2, 2.0), any, any), utility.nothing(any));
  EXPECT_LT(utility.split(goals(0.2, 1.4), any, any), utility.nothing(any));
  EXPECT_LT(utility.split(goals(0.2, 2.0, 0.0, 5.0), any, any), utility.nothing(any));
  EXPECT_GT(utility.split(goals(0.2, 3.0, 0.0, 5.0), any, any), utility.nothing(any));
  // A segment meets the field with any part of it.
  EXPECT_GT(utility.split(goals(0.2, 2.0, 0.0, -3.5), any, any), utility.nothing(any));
}

TEST(ViewpointDependentUtility, WhenTheObserverHasLeftWhatIsTooShortIsMergedAgain) {
  ViewpointDependentOptions options;
  options.far = {0.1, 3.0, 0.25};
  options.radius = 2.0;
  ViewpointDependentUtility utility(options);
  const SegmentGoals any, rough = goals(0.2, 2.5);
  utility.observe({0.0, 1.0});
  EXPECT_LT(utility.merge(any, any, rough), utility.nothing(any));
  utility.observe({50.0, 1.0});
  EXPECT_TRUE(utility.reconsider(rough.start, rough.end));
  EXPECT_GT(utility.merge(any, any, rough), utility.nothing(any));
  EXPECT_LT(utility.merge(any, any, goals(0.2, 3.5)), utility.nothing(any));
  utility.observe({60.0, 1.0});
  EXPECT_FALSE(utility.reconsider(rough.start, rough.end));
}

TEST(ViewpointDependentUtility, AFixedViewpointDoesNotFollowTheSensor) {
  ViewpointDependentOptions options;
  options.fixed = true;
  options.viewpoint = {1.0, 0.0};
  ViewpointDependentUtility utility(options);
  utility.observe({100.0, 0.0});
  const SegmentGoals any;
  EXPECT_GT(utility.split(goals(0.2, 0.5), any, any), utility.nothing(any));
  EXPECT_FALSE(utility.reconsider({0.0, 0.0}, {1.0, 0.0}));
}

TEST(DescriptionLengthUtility, SplitsForWhatTheDescriptionGetsShorterBy) {
  const DescriptionLengthUtility utility({0.1, 4.0});
  // 0.5 m^2 of misfit saved / (2 * .01) = 25 nat, for 4 nat.
  EXPECT_NEAR(utility.split(goals(0, 0, 0.7), goals(0, 0, 0.1), goals(0, 0, 0.1)), 21.0, 1e-12);
  EXPECT_NEAR(utility.merge(goals(0, 0, 0.1), goals(0, 0, 0.1), goals(0, 0, 0.7)), -21.0, 1e-12);
  EXPECT_NEAR(utility.merge(goals(0, 0, 0.1), goals(0, 0, 0.1), goals(0, 0, 0.2)), 4.0, 1e-12);
  EXPECT_DOUBLE_EQ(utility.nothing({}), 0.0);
}

TEST(UserUtility, IsMadeOfFunctionsAndNeverWinsWithoutThem) {
  UserUtility utility;
  EXPECT_EQ(utility.split({}, {}, {}), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(utility.merge({}, {}, {}), -std::numeric_limits<double>::infinity());
  utility.split_vote = [](const SegmentGoals& whole, const SegmentGoals&, const SegmentGoals&) { return whole.length; };
  utility.nothing_vote = [](const SegmentGoals&) { return 2.0; };
  EXPECT_DOUBLE_EQ(utility.split(goals(0, 7.0), {}, {}), 7.0);
  EXPECT_DOUBLE_EQ(utility.nothing({}), 2.0);
}

TEST(CombinedUtility, AddsWeightedVotesAndPassesTheObserverOn) {
  ViewpointDependentOptions options;
  options.radius = 2.0;
  const auto dependent = std::make_shared<ViewpointDependentUtility>(options);
  const auto user = std::make_shared<UserUtility>();
  user->split_vote = [](const SegmentGoals&, const SegmentGoals&, const SegmentGoals&) { return 10.0; };
  user->merge_vote = [](const SegmentGoals&, const SegmentGoals&, const SegmentGoals&) { return 1.0; };
  user->nothing_vote = [](const SegmentGoals&) { return 1.0; };
  CombinedUtility utility({{dependent, 2.0}, {user, 0.1}});
  utility.observe({0.0, 0.0});
  EXPECT_NEAR(utility.split(goals(0.2, 0.5), {}, {}), 2.0 * 1.0 + 0.1 * 10.0, 1e-12);
  EXPECT_NEAR(utility.nothing({}), 2.0 * 0.5 + 0.1, 1e-12);
  utility.observe({9.0, 0.0});
  EXPECT_TRUE(utility.reconsider({0.0, 0.0}, {1.0, 0.0}));
}

TEST(Utilities, RefuseOptionsThatAreUnusable) {
  EXPECT_THROW(ViewpointInvariantUtility({0.0, 1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(ViewpointInvariantUtility({0.1, -1.0, 0.5}), std::invalid_argument);
  EXPECT_THROW(ViewpointInvariantUtility({0.1, 1.0, 1.0}), std::invalid_argument);
  ViewpointDependentOptions dependent;
  dependent.scale = 0.0;
  EXPECT_THROW(ViewpointDependentUtility{dependent}, std::invalid_argument);
  EXPECT_THROW(DescriptionLengthUtility({std::nan(""), 1.0}), std::invalid_argument);
  try {
    DescriptionLengthUtility({-0.25, 1.0});
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "sigma = -0.25: must be positive");
  }
  EXPECT_THROW(CombinedUtility({}), std::invalid_argument);
  EXPECT_THROW(CombinedUtility({{nullptr, 1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
