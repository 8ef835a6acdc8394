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
  Scale,         ///< one colour per scale
  Height,        ///< of the mean along `up` [m]
  Normal,        ///< normalColour() of the axis of least variance
  Weight,        ///< number of points, log10
  Occupancy,     ///< log-odds
  Error,         ///< gaussianErrors() [m]
  Contribution,  ///< contributions() to the error of the coarser scale
  CellError      ///< errorsOfCells(): the error of the cell of the Gaussian
};
inline constexpr int kColourings = 8;  ///< number of values of ColourBy

/// Colours and what they mean.
struct Colouring {
  std::vector<detail::Colour> colours;  ///< one per Gaussian
  std::string title;                    ///< of the colour bar
  /// Colours of the colour bar: either equal steps from `low` to `high`, or one colour per name.
  std::vector<detail::Colour> bar;
  double low = 0.0, high = 1.0;
  bool is_logarithmic = false;     ///< equal steps of colour are equal factors
  std::vector<std::string> names;  ///< empty, or one per colour of `bar`
};

struct ColouringOptions {
  ColourBy by = ColourBy::Height;
  Vector<3> up = Vector<3>::UnitZ();  ///< unit vector
};

/// Returns true if the colours show one of the errors below, which colouringOf() must be given.
bool showsErrors(ColourBy by);

/// Returns the colours of Gaussians. `errors`: one per Gaussian, used if showsErrors(). Values that are not finite are
/// grey.
Colouring colouringOf(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians,
                      const ColouringOptions& options, const std::vector<double>& errors);

/// Returns, for every Gaussian of a scale, the mean distance [m] of its samples to the nearest point of `reference`;
/// NaN for a Gaussian without samples. Without reference points, the distances are to the means of leaves(), and NaN
/// for the finest scale. The same map and reference give the same errors.
std::vector<double> gaussianErrors(const GaussianMap<3>& map, int scale, const std::vector<Vector<3>>& reference);

/// Returns, for every Gaussian of a scale, its contribution to the error of the cell of the next coarser scale, see
/// cellErrors(); NaN at the coarsest scale.
std::vector<double> contributions(const GaussianMap<3>& map, int scale);
/// Returns, for every Gaussian of a scale, the error of its cell, see cellErrors(); NaN at the finest scale and in
/// cells without finer ones.
std::vector<double> errorsOfCells(const GaussianMap<3>& map, int scale);

}  // namespace gaussmap
