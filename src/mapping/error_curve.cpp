// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/error_curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/evaluation/nearest_distances.h"
#include "gaussmap/evaluation/sample_map.h"
#include "mapping/refine_scale.h"

namespace gaussmap {
namespace {

/// Measures cuts of coarse scales against samples of the finest.
class CutMeter {
 public:
  CutMeter(const GaussianMap<3>& map, const RefineOptions& options, const CurveOptions& curve)
      : grid_(map.grid()), curve_(curve), threads_(options.threads) {
    SampleOptions data{curve.data, 1, SampleShare::Mass, curve.seed, options.threads};
    if (!map.empty()) data_ = sampleMap(map, 0, data).points;
  }

  ErrorPoint measure(const MapScale<3>& cut, int scale) const {
    MapScale<3> alone;  // the scale as a map of its own: its samples need nothing else, but its key order is another
    alone.first_gaussian.push_back(0);
    for (const std::uint32_t from : keyOrder<3>(cut.keys, 2, 0)) {
      alone.keys.push_back(cut.keys[from]);
      for (std::size_t i = cut.first_gaussian[from]; i < cut.first_gaussian[from + 1]; ++i)
        alone.gaussians.push_back(cut.gaussians[i]);
      alone.first_gaussian.push_back(static_cast<std::uint32_t>(alone.gaussians.size()));
    }
    const GaussianMap<3> map({grid_.side(scale), 2, 1, grid_.options().noise}, {alone});
    const SampleOptions options{curve_.samples, 1, SampleShare::Volume, curve_.seed, threads_};
    const DistanceSummary error = summarise(nearestDistances(sampleMap(map, 0, options).points, data_, threads_));
    return {cut.gaussians.size(), error.q99, error.q95, error.mean};
  }

 private:
  const Grid<3> grid_;
  const CurveOptions curve_;
  const int threads_;
  std::vector<Vector<3>> data_;
};

void checkCurve(const CurveOptions& curve) {
  if (curve.samples == 0 || curve.data == 0) throw std::invalid_argument("samples = 0: a curve needs some");
  for (std::size_t i = 0; i < curve.multiples.size(); ++i)
    if (!(curve.multiples[i] >= 1.0) || (i > 0 && curve.multiples[i] <= curve.multiples[i - 1]))
      throw std::invalid_argument("multiples: must be at least 1 and rise");
}

/// The curve of a scale at the multiples asked for, as far as there are Gaussians.
ErrorCurve curveOf(const CutMeter& meter, const ScaleCuts<3>& cuts, const CurveOptions& options) {
  ErrorCurve curve{cuts.scale(), {}};
  for (const double multiple : options.multiples) {
    const std::size_t extra = std::min(cuts.extraOf(multiple), cuts.mostExtra());
    const ErrorPoint point = meter.measure(cuts.cut(extra), cuts.scale());
    if (curve.points.empty() || point.gaussians > curve.points.back().gaussians) curve.points.push_back(point);
    if (extra == cuts.mostExtra()) break;
  }
  return curve;
}

RefineOptions byAgglomeration(RefineOptions options) {
  if (options.method != RefineMethod::Agglomerate)
    throw std::invalid_argument("method: only agglomeration has one dendrogram for all budgets");
  return options;
}

}  // namespace

RefinedMap refineWithCurves(GaussianMap<3> map, const RefineOptions& options, const CurveOptions& curve) {
  checkCurve(curve);
  const CutMeter meter(map, options, curve);
  std::vector<ErrorCurve> curves;
  GaussianMap<3> refined = refineByChoice<3>(std::move(map), byAgglomeration(options), [&](const ScaleCuts<3>& cuts) {
    curves.push_back(curveOf(meter, cuts, curve));
    return cuts.extraAllowed(options);
  });
  return {std::move(refined), std::move(curves)};
}

RefinedToError refineToError(GaussianMap<3> map, double max_error, const RefineOptions& options,
                             const CurveOptions& curve) {
  checkCurve(curve);
  if (!(std::isfinite(max_error) && max_error > 0.0))
    throw std::invalid_argument("max_error = " + std::to_string(max_error) + ": must be a positive number of metres");
  const CutMeter meter(map, options, curve);
  std::vector<ErrorCurve> curves;
  std::vector<ErrorNotReached> not_reached;
  GaussianMap<3> refined = refineByChoice<3>(std::move(map), byAgglomeration(options), [&](const ScaleCuts<3>& cuts) {
    curves.push_back(curveOf(meter, cuts, curve));
    const auto error = [&](std::size_t extra) { return meter.measure(cuts.cut(extra), cuts.scale()).q95; };
    std::size_t low = 0, high = cuts.mostExtra();  // error(low) too large, error(high) small enough
    const double least = error(high);
    if (least > max_error) {
      not_reached.push_back({cuts.scale(), least});
      return high;
    }
    if (error(low) <= max_error) return low;
    while (high - low > 1 + high / 200) {  // to half a percent
      const std::size_t middle = low + (high - low) / 2;
      (error(middle) <= max_error ? high : low) = middle;
    }
    return high;
  });
  return {{std::move(refined), std::move(curves)}, std::move(not_reached)};
}

RefinedMap refineToBytes(const GaussianMap<3>& map, std::uintmax_t max_bytes,
                         const std::function<std::uintmax_t(const RefinedMap&)>& bytesOf, const RefineOptions& options,
                         const CurveOptions& curve) {
  constexpr double kPrecision = 1.02;  // of the budget
  const auto refined = [&](double budget) {
    RefineOptions with = options;
    with.budget = budget;
    return refineWithCurves(map, with, curve);
  };
  RefinedMap best = refined(1.0);
  const std::uintmax_t least = bytesOf(best);
  if (least > max_bytes)
    throw std::invalid_argument("max_bytes = " + std::to_string(max_bytes) + ": one Gaussian per cell takes " +
                                std::to_string(least) + " bytes already; take coarser cells");
  std::size_t fewest_cells = map.cellCount(0);
  for (int s = 1; s < map.scales(); ++s) fewest_cells = std::min(fewest_cells, map.cellCount(s));
  const double most = std::max(1.0, static_cast<double>(map.gaussianCount(0)) / std::max(1.0, double(fewest_cells)));
  double fits = 1.0, too_large = 0.0;  // budgets; 0: none known
  for (double next = 2.0; fits < most && (too_large == 0.0 || too_large > fits * kPrecision);) {
    RefinedMap tried = refined(std::min(next, most));
    if (bytesOf(tried) <= max_bytes) {
      best = std::move(tried);
      fits = std::min(next, most);
    } else {
      too_large = next;
    }
    next = too_large == 0.0 ? 2.0 * fits : std::sqrt(fits * too_large);
  }
  return best;
}

}  // namespace gaussmap
