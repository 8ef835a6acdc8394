// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/segments/segment_fitter.h"

namespace gaussmap::app {

/// The fitting options of `gaussmap segments`. An option that is not given keeps the default of the library.
struct FitterInput {
  SegmentFitterOptions options;
  std::string utility = "description-length";
  std::optional<double> min_length, sigma, segment_cost, merge_ratio, view_radius, view_scale;
  std::vector<double> viewpoint;  // x y r, or empty
  std::string observer_path;      // file, or empty
  bool no_prune = false, no_refine = false, as_in_paper = false;
};

/// Adds these options as a separate group.
void addFitterOptions(Command& command, FitterInput& input);
/// Returns the name of an option of this group that was given; empty if none was given.
std::string givenFitterOption(const Command& command);

/// Both throw UsageError for an option that does not apply to the chosen utility or policy.
SegmentFitterOptions fitterOptions(const FitterInput& input);
std::shared_ptr<SegmentUtility> makeUtility(const FitterInput& input);

}  // namespace gaussmap::app
