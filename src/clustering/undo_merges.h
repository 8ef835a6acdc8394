// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::detail {

/// What undoing the last merge, the one before, ... gains per Gaussian: their costs, but where a cheap merge stands
/// before dearer ones, the mean of them all, so that it does not bar the way to them. Never rising: the slopes of the
/// concave majorant of the summed costs, so that taking the largest first saves most, summed over all cells.
std::vector<double> gainsOfUndoing(const Dendrogram& dendrogram);

/// How many parts each cell is cut into when `extra` merges are undone, those of largest gain first (equal gains: the
/// smaller cell); fewer if there are no more. `gains` as from gainsOfUndoing(), per cell.
std::vector<std::size_t> partsPerCell(const std::vector<std::vector<double>>& gains, std::size_t extra);

}  // namespace gaussmap::detail
