// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/refine.h"

namespace gaussmap::detail {

// The cases of refine(), with options that are checked.

/// PerCell and MaxGaussians without curves.
template <int D>
GaussianMap<D> refineByCount(GaussianMap<D> map, const Budget& budget, const RefineOptions& options);

/// With error curves, by PerCell, MaxGaussians or MaxError.
RefineResult<3> refineMeasured(GaussianMap<3> map, const Budget& budget, const RefineOptions& options);

/// MaxBytes.
RefineResult<3> refineToBytes(GaussianMap<3> map, const MaxBytes& budget, const RefineOptions& options);

}  // namespace gaussmap::detail
