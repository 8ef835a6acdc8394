// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::detail {

/// What undoing the last merge, the one before, ... gains per Gaussian: its cost. If a cheap merge comes before more
/// expensive ones, all get their mean cost, so that the cheap one does not bar the way to the others. The gains never
/// rise: they are the slopes of the concave majorant of the summed costs. So taking the largest first saves most,
/// summed over all cells.
std::vector<double> mergeGains(const Dendrogram& dendrogram);

/// How many parts each cell is cut into when `extra` merges are undone, those of largest gain first (equal gains: the
/// smaller cell); fewer if there are no more. `gains` as from mergeGains(), per cell.
std::vector<std::size_t> partsPerCell(const std::vector<std::vector<double>>& gains, std::size_t extra);

}  // namespace gaussmap::detail
