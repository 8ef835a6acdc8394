// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/segments/segment_fitter.h"

namespace gaussmap::app {

/// How `gaussmap segments` fits. Options that are not given keep the default of the library.
struct FitterInput {
  SegmentFitterOptions options;
  std::string utility = "description-length";
  std::optional<double> min_length, sigma, segment_cost, merge_ratio, view_radius, view_scale;
  std::vector<double> viewpoint;  // x y r, or empty
  bool no_prune = false, no_refine = false;
};

/// Adds all of them, as a group of their own.
void addFitterOptions(Command& command, FitterInput& input);
/// The name of an option of this group that was given, empty if none was.
std::string givenFitterOption(const Command& command);

/// Throws UsageError for an option that the chosen utility or policy does not have.
SegmentFitterOptions fitterOptions(const FitterInput& input);
std::shared_ptr<SegmentUtility> makeUtility(const FitterInput& input);

}  // namespace gaussmap::app
