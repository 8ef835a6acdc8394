// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "gaussmap/mapping/refine.h"
#include "mapping/scale_clusters.h"

namespace gaussmap::detail {

/// Refines a coarse scale by RefineMethod::Insert. The scale gets at most `extra` clusters beyond one per cell.
template <int D>
void refineByInsertion(const ScalePair<D>& scale, std::size_t extra, const RefineOptions& options);

}  // namespace gaussmap::detail
