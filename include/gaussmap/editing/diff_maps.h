// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What became of a Gaussian. The numbers are the labels in files.
enum class Change : std::uint8_t {
  None = 0,    ///< no significant difference, or too few points to tell
  New = 1,     ///< only the second map has something there
  Gone = 2,    ///< only the first one has
  Changed = 3  ///< both have, and the means differ
};

struct DiffOptions {
  int scale = 0;         ///< which Gaussians are compared
  double level = 0.01;   ///< of the tests: how probable a chance result must be at most to be no chance, 0 < level < 1
  double points = 10.0;  ///< of one object count as independent, at most: those of one scan are not; >= 1
  int threads = 0;       ///< 0 = all; never shows in the result
};

/// One Gaussian, compared with the other map.
struct Difference {
  Change change = Change::None;
  double p_value = 1.0;  ///< of the test that decided
};

struct GAUSSMAP_API MapDiff {
  std::vector<Difference> first;           ///< of the Gaussians of the first map: None, Gone or Changed
  std::vector<Difference> second;          ///< of the second: None, New or Changed
  std::size_t count(Change change) const;  ///< New and Changed of the second, Gone of the first; None of the second
};

/// What differs between two maps of the same place, Gaussian by Gaussian of one scale.
///
/// The same: some Gaussian of the other map, in the same cell or one next to it, has the same mean by Wald's test,
/// p = P(chi^2_D >= d' (S_1 / n_1 + S_2 / n_2)^-1 d), d = difference of the means, n = number of points but at most
/// `points`, S = covariance, with one point's weight of that of a whole cell (so few points prove little). Of what is
/// left in a cell on both sides, the nearest are pairs and have changed. The rest is new or gone, if that is no chance:
/// a point of the second map falls with the same probability anywhere that it did in the first, so that all n points of
/// a place belong to one map with p = share^n, share = that map's part of the points in the cells of both.
///
/// Does not know where the sensors looked: what the second map never saw is gone too. At scales with several Gaussians
/// a cell, clusters that were cut otherwise differ, though the surface is the same (simulated street, other noise: 4 %
/// of the clusters of scale 1 at a level of 1 %, of the finest scale 0.002 %). Throws std::invalid_argument, naming the
/// option, if the cells of the scale differ or an option is not usable.
template <int D>
GAUSSMAP_API MapDiff diffMaps(const GaussianMap<D>& first, const GaussianMap<D>& second,
                              const DiffOptions& options = {});

}  // namespace gaussmap
