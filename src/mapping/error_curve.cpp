// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/error_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "core/quantile.h"
#include "map/boxes_of_parents.h"
#include "map/member_boxes.h"
#include "map/sample_within.h"
#include "mapping/refine_scale.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Measures cuts of coarse scales against samples of the finest, one scale after the other from the finest up.
class CutMeter {
 public:
  CutMeter(const GaussianMap<3>& map, const RefineOptions& options, const CurveOptions& curve)
      : grid_(map.grid()), curve_(curve), threads_(options.threads), finer_boxes_(memberBoxes<3>(map, 0)) {
    SampleOptions data{curve.data, 1, SampleShare::Mass, curve.seed, options.threads};
    if (!map.empty()) data_ = sampleMap(map, 0, data).points;
  }

  ErrorPoint measure(const ScaleCuts<3>& cuts, std::size_t extra) const {
    const ScaleCut<3> cut = cuts.cut(extra);
    const std::vector<Box<3>> boxes = boxesOfParents<3>(finer_boxes_, cut.parent, cut.gaussians.size());
    MapScale<3> alone;  // the scale as a map of its own: its samples need nothing else, but its key order is another
    std::vector<Box<3>> alone_boxes;
    alone.first_gaussian.push_back(0);
    for (const std::uint32_t from : keyOrder<3>(cuts.keys(), 2, 0)) {
      alone.keys.push_back(cuts.keys()[from]);
      for (std::size_t i = cut.first_gaussian[from]; i < cut.first_gaussian[from + 1]; ++i) {
        alone.gaussians.push_back(cut.gaussians[i]);
        alone_boxes.push_back(boxes[i]);
      }
      alone.first_gaussian.push_back(static_cast<std::uint32_t>(alone.gaussians.size()));
    }
    const GaussianMap<3> map({grid_.side(cuts.scale()), 2, 1, grid_.options().noise}, {alone});
    const SampleOptions options{curve_.samples, 1, SampleShare::Volume, curve_.seed, threads_};
    const std::vector<Vector<3>> samples = sampleWithin<3>(map, 0, alone_boxes, options).points;
    std::vector<double> distances = nearestDistances(samples, data_, threads_);
    const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
    const double mean = sum / static_cast<double>(distances.size());
    const double q99 = percentile(distances, 99);
    return {cut.gaussians.size(), q99, percentile(distances, 95), mean};
  }

  /// This cut becomes the finer scale of the next one. Returns `extra`.
  std::size_t choose(const ScaleCuts<3>& cuts, std::size_t extra) {
    const ScaleCut<3> cut = cuts.cut(extra);
    finer_boxes_ = boxesOfParents<3>(finer_boxes_, cut.parent, cut.gaussians.size());
    return extra;
  }

 private:
  const Grid<3> grid_;
  const CurveOptions curve_;
  const int threads_;
  std::vector<Vector<3>> data_;
  std::vector<Box<3>> finer_boxes_;  // memberBoxes() of the finer scale
};

void checkCurve(const CurveOptions& curve) {
  require(curve.samples >= 1, "samples", static_cast<double>(curve.samples), "must be at least 1");
  require(curve.data >= 1, "data", static_cast<double>(curve.data), "must be at least 1");
  for (std::size_t i = 0; i < curve.multiples.size(); ++i)
    require(curve.multiples[i] >= 1.0 && (i == 0 || curve.multiples[i] > curve.multiples[i - 1]), "multiples",
            curve.multiples[i], "must be at least 1 and ascending");
}

/// The curve of a scale at the multiples asked for, as far as there are Gaussians.
ErrorCurve curveOf(const CutMeter& meter, const ScaleCuts<3>& cuts, const CurveOptions& options) {
  ErrorCurve curve{cuts.scale(), {}};
  for (const double multiple : options.multiples) {
    const std::size_t extra = std::min(cuts.extraOf(multiple), cuts.mostExtra());
    const ErrorPoint point = meter.measure(cuts, extra);
    if (curve.points.empty() || point.gaussians > curve.points.back().gaussians) curve.points.push_back(point);
    if (extra == cuts.mostExtra()) break;
  }
  return curve;
}

/// Curves that are longer than any true ones when they are written in decimals.
std::vector<ErrorCurve> widestCurves(int scales, const CurveOptions& options) {
  constexpr double kLong = 1.2345678901234567e-100;
  std::vector<ErrorCurve> curves;
  for (int s = 1; s < scales; ++s)
    curves.push_back({s, {options.multiples.size(), {std::numeric_limits<std::uint32_t>::max(), kLong, kLong, kLong}}});
  return curves;
}

RefineOptions byAgglomeration(RefineOptions options) {
  if (options.method != RefineMethod::Agglomerate)
    throw std::invalid_argument("method: only agglomeration has one dendrogram for all budgets");
  return options;
}

}  // namespace

RefinedMap refineWithCurves(GaussianMap<3> map, const RefineOptions& options, const CurveOptions& curve) {
  checkCurve(curve);
  CutMeter meter(map, options, curve);
  std::vector<ErrorCurve> curves;
  GaussianMap<3> refined = refineByChoice<3>(std::move(map), byAgglomeration(options), [&](const ScaleCuts<3>& cuts) {
    curves.push_back(curveOf(meter, cuts, curve));
    return meter.choose(cuts, cuts.extraAllowed(options));
  });
  return {std::move(refined), std::move(curves)};
}

RefinedToError refineToError(GaussianMap<3> map, double max_error, const RefineOptions& options,
                             const CurveOptions& curve) {
  checkCurve(curve);
  require(std::isfinite(max_error) && max_error > 0.0, "max_error", max_error, "must be a positive number of metres");
  CutMeter meter(map, options, curve);
  std::vector<ErrorCurve> curves;
  std::vector<ErrorNotReached> not_reached;
  GaussianMap<3> refined = refineByChoice<3>(std::move(map), byAgglomeration(options), [&](const ScaleCuts<3>& cuts) {
    curves.push_back(curveOf(meter, cuts, curve));
    const auto error = [&](std::size_t extra) { return meter.measure(cuts, extra).q95; };
    std::size_t low = 0, high = cuts.mostExtra();  // error(low) too large, error(high) small enough
    const double least = error(high);
    if (least > max_error) {
      not_reached.push_back({cuts.scale(), least});
      return meter.choose(cuts, high);
    }
    if (error(low) <= max_error) return meter.choose(cuts, low);
    while (high - low > 1 + high / 200) {  // to half a percent
      const std::size_t middle = low + (high - low) / 2;
      (error(middle) <= max_error ? high : low) = middle;
    }
    return meter.choose(cuts, high);
  });
  return {{std::move(refined), std::move(curves)}, std::move(not_reached)};
}

RefinedMap refineToBytes(const GaussianMap<3>& map, std::uintmax_t max_bytes,
                         const std::function<std::uintmax_t(const RefinedMap&)>& bytesOf, const RefineOptions& options,
                         const CurveOptions& curve) {
  constexpr double kPrecision = 1.02;  // of the budget
  checkCurve(curve);
  const auto with = [&](double budget) {
    RefineOptions changed = byAgglomeration(options);
    changed.budget = budget;
    return changed;
  };
  std::size_t fewest_cells = map.cellCount(0);
  for (int s = 1; s < map.scales(); ++s) fewest_cells = std::min(fewest_cells, map.cellCount(s));
  const double most = std::max(1.0, static_cast<double>(map.gaussianCount(0)) / std::max(1.0, double(fewest_cells)));
  const auto allowed = static_cast<double>(max_bytes);

  // True curves take longer than all the rest: they are made last, and only for the budget that is chosen.
  RefinedMap trial{refine<3>(map, with(1.0)), widestCurves(map.scales(), curve)};
  double fits = 1.0, fits_bytes = static_cast<double>(bytesOf(trial));
  double too_large = 0.0, too_many_bytes = 0.0;  // 0: none known
  for (double next = 2.0;
       fits_bytes <= allowed && fits < most && (too_large == 0.0 || too_large > fits * kPrecision);) {
    const double budget = std::min(next, most);
    trial.map = refine<3>(map, with(budget));
    const auto bytes = static_cast<double>(bytesOf(trial));
    (bytes <= allowed ? fits : too_large) = budget;
    (bytes <= allowed ? fits_bytes : too_many_bytes) = bytes;
    // Between two budgets the bytes rise nearly straight; the bounds of the share make the rest certain.
    const double share = (allowed - fits_bytes) / (too_many_bytes - fits_bytes);
    next = too_large == 0.0 ? 2.0 * fits : fits + std::clamp(share, 0.1, 0.9) * (too_large - fits);
  }
  double step = kPrecision;
  while (fits > 1.0) {  // once, unless the curves are too much
    RefinedMap best = refineWithCurves(map, with(fits), curve);
    if (bytesOf(best) <= max_bytes) return best;
    fits /= step;
    step *= step;
  }
  RefinedMap one_per_cell = refineWithCurves(map, with(1.0), curve);
  const std::uintmax_t least = bytesOf(one_per_cell);
  if (least > max_bytes)
    throw std::invalid_argument("max_bytes = " + std::to_string(max_bytes) + ": one Gaussian per cell takes " +
                                std::to_string(least) + " bytes already; take coarser cells");
  return one_per_cell;
}

}  // namespace gaussmap
