// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/refine.h"

#include <utility>
#include <variant>

#include "core/check.h"
#include "mapping/budget.h"
#include "mapping/measured_refinement.h"
#include "mapping/refine_insert.h"
#include "mapping/refine_scales.h"

namespace gaussmap {
using namespace detail;

RefineOptions RefineOptions::yguel2009() {
  RefineOptions options;
  options.method = RefineMethod::Insert;
  options.queue = 4;
  options.seed_rule = ClusterSeed::InputGaussian;
  options.only_occupied = true;
  options.learning_factor = true;
  return options;
}

template <int D>
GaussianMap<D> detail::refineByCount(GaussianMap<D> map, const Budget& budget, const RefineOptions& options) {
  return refineScales<D>(std::move(map), [&](const ScalePair<D>& pair, const std::vector<double>& areas) {
    const std::size_t extra = extraGaussians(budget, pair.finer_scale + 1, pair.cells(), pair.finer.gaussianCount());
    if (options.method == RefineMethod::Insert)
      refineByInsertion(pair, extra, options);
    else if (extra > 0)
      setClusters(pair, ScaleClusters::under(pair, areas, options.merge_cost, options.threads).cut(extra),
                  options.threads);
  });
}

template <int D>
RefineResult<D> refine(GaussianMap<D> map, const Budget& budget, const RefineOptions& options) {
  checkRefinement(budget, options, map.scales(), D);
  if (const auto* bytes = std::get_if<MaxBytes>(&budget)) return refineToBytes(std::move(map), *bytes, options);
  if (options.curves || std::holds_alternative<MaxError>(budget))
    return refineMeasured(std::move(map), budget, options);
  return {refineByCount(std::move(map), budget, options), {}, {}};
}

#define GAUSSMAP_INSTANTIATE(D)                                                                          \
  template GaussianMap<D> detail::refineByCount<D>(GaussianMap<D>, const Budget&, const RefineOptions&); \
  template RefineResult<D> refine<D>(GaussianMap<D>, const Budget&, const RefineOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
