// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::test {

/// Returns true if the bits are equal: 0.0 and -0.0 differ, equal NaNs do not.
template <typename A>
bool sameBits(const A& a, const A& b) {
  return a.size() == b.size() &&
         (a.size() == 0 ||
          std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(*a.data())) == 0);
}

template <int D>
bool sameGaussian(const Gaussian<D>& a, const Gaussian<D>& b) {
  return sameBits(a.mean, b.mean) && sameBits(a.cov, b.cov) && std::memcmp(&a.weight, &b.weight, sizeof a.weight) == 0;
}

/// Compares which cell holds which Gaussians. A list with one Gaussian per cell and an empty list mean the same.
template <int D>
bool sameRanges(const GaussianMap<D>& a, const GaussianMap<D>& b, int s) {
  for (std::size_t cell = 0; cell < a.cellCount(s); ++cell)
    if (a.gaussiansOf(cell, s).first != b.gaussiansOf(cell, s).first ||
        a.gaussiansOf(cell, s).last != b.gaussiansOf(cell, s).last)
      return false;
  return true;
}

/// Compares everything in two maps, bit by bit. Returns success, or the first thing that differs.
template <int D>
testing::AssertionResult sameMap(const GaussianMap<D>& a, const GaussianMap<D>& b) {
  if (!(a.options() == b.options())) return testing::AssertionFailure() << "options";
  for (int s = 0; s < a.scales(); ++s) {
    const MapScale<D>&x = a.scale(s), &y = b.scale(s);
    const auto differ = [s](const char* what) { return testing::AssertionFailure() << what << " of scale " << s; };
    if (x.keys != y.keys) return differ("keys");
    if (x.first_child != y.first_child && !(x.keys.empty() && y.keys.empty())) return differ("children");
    if (x.moments != y.moments) return differ("moments");
    if (x.parent != y.parent) return differ("parents");
    if (!sameBits(x.log_odds, y.log_odds)) return differ("occupancy");
    if (x.gaussians.size() != y.gaussians.size()) return differ("number of Gaussians");
    for (std::size_t i = 0; i < x.gaussians.size(); ++i)
      if (!sameGaussian<D>(x.gaussians[i], y.gaussians[i])) return differ("a Gaussian");
    if (!sameRanges<D>(a, b, s)) return differ("Gaussians of a cell");
    if (a.weight(s) != b.weight(s)) return differ("weight");
  }
  return testing::AssertionSuccess();
}

template <int D>
void expectSameMap(const GaussianMap<D>& a, const GaussianMap<D>& b) {
  EXPECT_TRUE(sameMap<D>(a, b));
}

}  // namespace gaussmap::test
