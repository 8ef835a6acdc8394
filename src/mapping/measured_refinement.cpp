// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/measured_refinement.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include "core/in_space.h"
#include "core/quantile.h"
#include "map/map_scale_builder.h"
#include "map/member_boxes.h"
#include "map/parent_boxes.h"
#include "map/sample_within.h"
#include "mapping/budget.h"
#include "mapping/refine_scales.h"
#include "points/nearest_distances.h"

namespace gaussmap::detail {
namespace {

/// Measures the error of cuts of coarse scales against samples of the finest scale. The order is from fine to coarse.
template <int D>
class CutErrorMeter {
 public:
  CutErrorMeter(const GaussianMap<D>& map, const ErrorSampling& sampling, int threads)
      : grid_(map.grid()), sampling_(sampling), threads_(threads), finer_boxes_(memberBoxes<D>(map, 0)) {
    const SampleOptions data{sampling.data, 1, SampleShare::Mass, sampling.seed, threads};
    if (!map.empty()) data_ = inSpace(sampleMap(map, 0, data).points);
  }

  ErrorPoint measure(const ScalePair<D>& pair, const ClusterCut& cut) const {
    const std::vector<Gaussian<D>> gaussians = clusterGaussians(pair, cut, threads_);
    const std::vector<Box<D>> boxes = parentBoxes<D>(finer_boxes_, cut.cluster, gaussians.size());
    MapScaleBuilder<D> alone;  // a map of this scale only is enough for samples; its key order is different
    std::vector<Box<D>> alone_boxes;
    for (const std::uint32_t from : keyOrder<D>(pair.coarse.keys, 2, 0)) {
      alone.addCell(pair.coarse.keys[from]);
      for (std::size_t i = cut.first[from]; i < cut.first[from + 1]; ++i) {
        alone.addGaussian(gaussians[i]);
        alone_boxes.push_back(boxes[i]);
      }
    }
    const GaussianMap<D> map({grid_.side(pair.finer_scale + 1), 2, 1, grid_.options().noise}, {alone.take()});
    const SampleOptions options{sampling_.samples, 1, SampleShare::Volume, sampling_.seed, threads_};
    const std::vector<Vector<3>> samples = inSpace(sampleWithin<D>(map, 0, alone_boxes, options).points);
    std::vector<double> distances = nearestDistances(samples, data_, threads_);
    const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
    const double mean = sum / static_cast<double>(distances.size());
    const double q99 = percentile(distances, 99);
    return {gaussians.size(), q99, percentile(distances, 95), mean};
  }

  /// Makes this cut the finer scale of the next measurements.
  void choose(const ClusterCut& cut) { finer_boxes_ = parentBoxes<D>(finer_boxes_, cut.cluster, cut.clusters()); }

 private:
  const Grid<D> grid_;
  const ErrorSampling sampling_;
  const int threads_;
  std::vector<Vector<3>> data_;      // in space
  std::vector<Box<D>> finer_boxes_;  // memberBoxes() of the finer scale
};

/// Returns the error curve of a scale at the given multiples. The curve ends when every finer Gaussian is a cluster.
template <int D>
ErrorCurve curveOf(const CutErrorMeter<D>& meter, const ScalePair<D>& pair, const ScaleClusters& clusters,
                   const std::vector<double>& multiples) {
  ErrorCurve curve{pair.finer_scale + 1, {}};
  const std::size_t most = clusters.maxExtra();
  for (const double multiple : multiples) {
    const std::size_t extra =
        std::min(extraGaussians(PerCell{multiple}, curve.scale, pair.cells(), pair.finer.gaussianCount()), most);
    const ErrorPoint point = meter.measure(pair, clusters.cut(extra));
    if (curve.points.empty() || point.gaussians > curve.points.back().gaussians) curve.points.push_back(point);
    if (extra == most) break;
  }
  return curve;
}

/// Returns placeholder curves. Written as decimal text, they are at least as long as any measured curves.
std::vector<ErrorCurve> widestCurves(int scales, const CurveOptions& options) {
  constexpr double kLong = 1.2345678901234567e-100;
  std::vector<ErrorCurve> curves;
  for (int s = 1; s < scales; ++s)
    curves.push_back({s, {options.multiples.size(), {std::numeric_limits<std::uint32_t>::max(), kLong, kLong, kLong}}});
  return curves;
}

/// Returns the smallest number of Gaussians beyond one per cell that reaches the error, to within half a percent, by
/// bisection. If no number reaches it, returns the maximum and adds the scale to `not_reached`.
template <int D>
std::size_t extraForError(const CutErrorMeter<D>& meter, const ScalePair<D>& pair, const ScaleClusters& clusters,
                          double max_error, std::vector<NotReached>& not_reached) {
  const auto error = [&](std::size_t extra) { return meter.measure(pair, clusters.cut(extra)).q95; };
  std::size_t low = 0, high = clusters.maxExtra();  // error(low) is too large, error(high) small enough
  const double least = error(high);
  if (least > max_error) {
    not_reached.push_back({pair.finer_scale + 1, least});
    return high;
  }
  if (error(low) <= max_error) return low;
  while (high - low > 1 + high / 200) {
    const std::size_t middle = low + (high - low) / 2;
    (error(middle) <= max_error ? high : low) = middle;
  }
  return high;
}

}  // namespace

template <int D>
RefineResult<D> refineMeasured(GaussianMap<D> map, const Budget& budget, const RefineOptions& options) {
  const auto* max_error = std::get_if<MaxError>(&budget);
  CutErrorMeter<D> meter(map, max_error != nullptr ? max_error->sampling : options.curves->sampling, options.threads);
  RefineResult<D> result;
  result.map = refineScales<D>(std::move(map), [&](const ScalePair<D>& pair, const std::vector<double>& areas) {
    const ScaleClusters clusters = ScaleClusters::under(pair, areas, options.merge_cost, options.threads);
    if (options.curves) result.curves.push_back(curveOf(meter, pair, clusters, options.curves->multiples));
    const std::size_t extra =
        max_error != nullptr ? extraForError(meter, pair, clusters, max_error->metres, result.not_reached)
                             : extraGaussians(budget, pair.finer_scale + 1, pair.cells(), pair.finer.gaussianCount());
    ClusterCut cut = clusters.cut(extra);
    meter.choose(cut);
    setClusters(pair, std::move(cut), options.threads);
  });
  return result;
}

template <int D>
RefineResult<D> refineToBytes(GaussianMap<D> map, const MaxBytes& budget, const RefineOptions& options) {
  std::size_t fewest_cells = map.cellCount(0);
  for (int s = 1; s < map.scales(); ++s) fewest_cells = std::min(fewest_cells, map.cellCount(s));
  const double most = std::max(1.0, static_cast<double>(map.gaussianCount(0)) / std::max(1.0, double(fewest_cells)));

  // Measured curves take longer than everything else, so they are made last and only for the chosen multiple. A
  // refinement depends on the finest scale only, so the map of one trial is the input of the next.
  RefineResult<D> trial{std::move(map), {}, {}};
  if (options.curves) trial.curves = widestCurves(trial.map.scales(), *options.curves);
  double last = 0.0;
  const double fits = largestMultiple(most, budget.bytes, [&](double multiple) {
                        trial.map = refineByCount(std::move(trial.map), PerCell{multiple}, options);
                        last = multiple;
                        return sizeOf(budget, trial);
                      }).multiple;
  if (!options.curves && last == fits && fits > 1.0) return trial;
  double multiple = fits, step = kBytePrecision;
  while (multiple > 1.0) {  // runs once, unless the result exceeds the limit
    RefineResult<D> best = refine<D>(std::move(trial.map), PerCell{multiple}, options);
    if (sizeOf(budget, best) <= budget.bytes) return best;
    trial.map = std::move(best.map);
    multiple /= step;
    step *= step;
  }
  RefineResult<D> one_per_cell = refine<D>(std::move(trial.map), PerCell{1.0}, options);
  requireRoom(budget.bytes, sizeOf(budget, one_per_cell));
  return one_per_cell;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                    \
  template RefineResult<D> refineMeasured<D>(GaussianMap<D>, const Budget&, const RefineOptions&); \
  template RefineResult<D> refineToBytes<D>(GaussianMap<D>, const MaxBytes&, const RefineOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
