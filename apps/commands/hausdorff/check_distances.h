// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/evaluation/hausdorff.h"

namespace gaussmap::app {

/// Returns per point of `from` the distance to the nearest point of `to` [m], found by FLANN's exact kd-tree. Neither
/// set may be empty. `threads`: 0 = all cores.
std::vector<double> flannDistances(const std::vector<Vector<3>>& from, const std::vector<Vector<3>>& to, int threads);

/// Throws std::runtime_error if a distance differs from the second one by more than rounding. The message names the
/// point, as "point 17 of FROM", and both distances.
void requireSame(const std::vector<double>& distances, const std::vector<double>& again, const std::string& from);

/// Checks all distances of hausdorff() or Reference::compare() in both directions with FLANN's tree. Returns their
/// number. Throws like requireSame().
std::size_t checkDistances(const std::vector<Vector<3>>& reference, const PointDistances& distances, int threads);

/// Checks the result of hausdorffMaxima() in the same way.
std::size_t checkMaxima(const std::vector<Vector<3>>& subject, const std::vector<Vector<3>>& reference,
                        const HausdorffMaxima& maxima, int threads);

}  // namespace gaussmap::app
