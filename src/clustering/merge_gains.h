// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::detail {

/// Returns the gains per additional Gaussian when merges are undone, from the last merge to the first. The gain of a
/// merge is its cost. If a cheap merge must be undone before more expensive ones, all of them get their mean cost;
/// otherwise the cheap merge would block the others. The gains never rise: they are the slopes of the concave majorant
/// of the summed costs. Undoing the merges of largest gain first therefore saves the maximum, summed over all cells.
std::vector<double> mergeGains(const Dendrogram& dendrogram);

/// Returns the number of clusters per cell after `extra` merges are undone, those of largest gain first (equal gains:
/// the smaller cell). Fewer merges are undone if no more exist. `gains`: per cell, from mergeGains().
std::vector<std::size_t> partsPerCell(const std::vector<std::vector<double>>& gains, std::size_t extra);

}  // namespace gaussmap::detail
