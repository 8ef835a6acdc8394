// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The change of a Gaussian between two maps. Files store these numbers.
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
  /// Maximum number of points per Gaussian that the test counts as independent, >= 1. Many points of one scan are not
  /// independent, so they must not make the test too strict.
  double points = 10.0;
  int threads = 0;  ///< 0 = all cores
};

/// The result of comparing one Gaussian with the other map.
struct Difference {
  Change change = Change::None;  ///< what changed
  double p_value = 1.0;          ///< p-value of the test that decided about the change
};

/// The differences between two maps.
struct GAUSSMAP_API MapDiff {
  std::vector<Difference> first;   ///< per Gaussian of the first map: None, Gone or Changed
  std::vector<Difference> second;  ///< per Gaussian of the second map: None, New or Changed
  /// Returns the number of Gaussians with this change. Gone is counted in the first map; None, New and Changed are
  /// counted in the second map.
  std::size_t count(Change change) const;
};

/// Compares two maps of the same place, Gaussian by Gaussian of one scale.
///
/// 1. A Gaussian is unchanged if the other map has a Gaussian with the same mean, in the same cell or an adjacent one.
///    Wald's test decides: `p = P(chi^2_D >= d' (S_1 / n_1 + S_2 / n_2)^-1 d)` is at least DiffOptions::level. Here d
///    is the difference of the means, and n is the number of points, at most DiffOptions::points. S is the covariance
///    of the points and one additional point with the variance of a whole cell. This point keeps S large if there are
///    few points, so that few points seldom give a significant difference.
/// 2. The remaining Gaussians of a cell form pairs, one Gaussian of each map, the most similar ones first. Both
///    Gaussians of a pair are Changed.
/// 3. A Gaussian without a partner is Gone (first map) or New (second map) if p = share^n is below DiffOptions::level.
///    Here n is the number of its points. Of the points in the cells that both maps have, `share` is the fraction that
///    belongs to the map of the Gaussian. If the points are distributed in the same way in both maps, p is the
///    probability that all n points of a place come from this map by chance.
///
/// The function does not know where the sensors measured: a place that the second map did not observe is also Gone. At
/// scales with several Gaussians per cell, the same surface can be clustered differently and is then reported as
/// changed. Example: two maps of the same simulated street, whose scans have different noise, at a level of 1 %.
/// Wrongly reported are 4 % of the clusters of scale 1 and 0.002 % of the Gaussians of the finest scale.
///
/// Throws std::invalid_argument if the cells of the scale have different sides in the two maps, or an option is out of
/// range; the message names the option.
template <int D>
GAUSSMAP_API MapDiff diffMaps(const GaussianMap<D>& first, const GaussianMap<D>& second,
                              const DiffOptions& options = {});

}  // namespace gaussmap
