// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/queries.h"
#include "io/export/colours.h"

namespace gaussmap {

enum class ColourBy {
  Scale,      ///< one colour a scale
  Height,     ///< of the mean along `up` [m]
  Normal,     ///< normalColour() of the axis of least variance
  Weight,     ///< points, in powers of ten
  Occupancy,  ///< log-odds
  Error       ///< gaussianErrors() [m]
};

/// Colours and what they mean.
struct Colouring {
  std::vector<detail::Colour> colours;  ///< one a Gaussian
  std::string title;                    ///< of the colour bar
  /// Of the colour bar: either equal steps from `low` to `high`, or the names of its colours.
  std::vector<detail::Colour> bar;
  double low = 0.0, high = 1.0;
  std::vector<std::string> names;  ///< empty, or as many as `bar` has
};

struct ColouringOptions {
  ColourBy by = ColourBy::Height;
  Vector<3> up = Vector<3>::UnitZ();  ///< unit
};

/// `errors` = one a Gaussian, used for ColourBy::Error only. What is not finite is grey.
Colouring colouringOf(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians,
                      const ColouringOptions& options, const std::vector<double>& errors);

/// The mean distance [m] of a Gaussian's samples to the nearest point of `reference`, for every Gaussian of a scale;
/// NaN where no sample found a place. Without reference points: to the means of the finer detail, leaves(); NaN for
/// the finest scale, which has none. The same map and reference give the same errors.
std::vector<double> gaussianErrors(const GaussianMap<3>& map, int scale, const std::vector<Vector<3>>& reference);

}  // namespace gaussmap
