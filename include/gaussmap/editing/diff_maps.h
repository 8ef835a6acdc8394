// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The change of a Gaussian between two maps. The numbers are the labels in files.
enum class Change : std::uint8_t {
  None = 0,    ///< no significant difference, or too few points for a decision
  New = 1,     ///< only the second map has a surface here
  Gone = 2,    ///< only the first map has a surface here
  Changed = 3  ///< both maps have a surface here, but the means differ
};

/// Options of diffMaps().
struct DiffOptions {
  int scale = 0;        ///< scale whose Gaussians are compared
  double level = 0.01;  ///< significance level of the tests, 0 < level < 1
  /// Maximum number of points per Gaussian that count as independent, >= 1. The points of one scan are not independent.
  double points = 10.0;
  int threads = 0;  ///< 0 = all cores
};

/// The result of comparing one Gaussian with the other map.
struct Difference {
  Change change = Change::None;  ///< what changed
  double p_value = 1.0;          ///< of the test that decided
};

/// The differences between two maps.
struct GAUSSMAP_API MapDiff {
  std::vector<Difference> first;   ///< per Gaussian of the first map: None, Gone or Changed
  std::vector<Difference> second;  ///< per Gaussian of the second map: None, New or Changed
  /// Returns the number of Gaussians with a change. Gone is counted in the first map, the others in the second.
  std::size_t count(Change change) const;
};

/// Compares two maps of the same place, Gaussian by Gaussian of one scale.
///
/// 1. A Gaussian is unchanged if some Gaussian of the other map, in the same cell or an adjacent one, has the same mean
///    by Wald's test: `p = P(chi^2_D >= d' (S_1 / n_1 + S_2 / n_2)^-1 d)`. Here d is the difference of the means, and n
///    is the number of points, at most DiffOptions::points. S is the covariance after adding one point with the
///    variance of a whole cell, so few points prove little.
/// 2. Among the remaining Gaussians of a cell, the most similar ones of both maps form pairs and are Changed.
/// 3. The others are New or Gone, if this is significant. The test assumes that the points are distributed in the same
///    way in both maps. All n points of a place then belong to one map with p = share^n. Here share is the fraction of
///    the points that this map has in cells that both maps have.
///
/// The function does not know where the sensors measured: a place that the second map did not observe is also Gone. At
/// scales with several Gaussians per cell, the same surface can be clustered differently and is then reported as
/// changed. Example: a simulated street with different noise, at a level of 1 %. This affects 4 % of the clusters of
/// scale 1 and 0.002 % of those of the finest scale.
///
/// Throws std::invalid_argument if the cells of the scale differ or an option is out of range; the message names the
/// option.
template <int D>
GAUSSMAP_API MapDiff diffMaps(const GaussianMap<D>& first, const GaussianMap<D>& second,
                              const DiffOptions& options = {});

}  // namespace gaussmap
