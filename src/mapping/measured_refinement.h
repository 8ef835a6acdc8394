// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/refine.h"

namespace gaussmap::detail {

// The cases of refine(). The caller has checked the options.

/// The budgets PerCell and MaxGaussians, without error curves.
template <int D>
GaussianMap<D> refineByCount(GaussianMap<D> map, const Budget& budget, const RefineOptions& options);

/// The budgets PerCell and MaxGaussians with error curves, and MaxError.
template <int D>
RefineResult<D> refineMeasured(GaussianMap<D> map, const Budget& budget, const RefineOptions& options);

/// The budget MaxBytes, with or without error curves.
template <int D>
RefineResult<D> refineToBytes(GaussianMap<D> map, const MaxBytes& budget, const RefineOptions& options);

}  // namespace gaussmap::detail
