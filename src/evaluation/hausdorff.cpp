// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/evaluation/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gaussmap/evaluation/nearest_distances.h"

namespace gaussmap {
namespace {

/// Nearest rank, in integers: 0.95 * n would round up to the next rank for some n.
double percentile(std::vector<double>& values, std::size_t percent) {
  const std::size_t rank = values.size() / 100 * percent + (values.size() % 100 * percent + 99) / 100;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

DistanceSummary summarise(std::vector<double> distances) {
  if (distances.empty()) throw std::invalid_argument("no distances to summarise");
  DistanceSummary summary;
  summary.count = distances.size();
  double sum = 0.0, squares = 0.0;  // before the quantiles shuffle the values
  for (const double distance : distances) {
    sum += distance;
    squares += distance * distance;
    summary.max = std::max(summary.max, distance);
  }
  summary.mean = sum / static_cast<double>(summary.count);
  summary.rms = std::sqrt(squares / static_cast<double>(summary.count));
  summary.q99 = percentile(distances, 99);
  summary.q95 = percentile(distances, 95);
  return summary;
}

HausdorffResult hausdorff(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b, int threads) {
  if (a.empty() || b.empty()) throw std::invalid_argument("the Hausdorff distance of an empty set is not defined");
  return {summarise(nearestDistances(a, b, threads)), summarise(nearestDistances(b, a, threads))};
}

MapHausdorff evaluateMap(const GaussianMap<3>& map, int scale, const std::vector<Vector<3>>& reference,
                         const SampleOptions& options) {
  if (reference.empty()) throw std::invalid_argument("no reference points to compare the map with");
  const MapSamples<3> samples = sampleMap(map, scale, options);
  if (samples.points.empty()) throw std::invalid_argument("no samples: no Gaussian of the scale has mass in its cell");

  MapHausdorff result;
  result.gaussians = map.gaussianCount(scale);
  result.samples = samples.points.size();
  result.unplaced = samples.unplaced;
  std::vector<double> forward = nearestDistances(samples.points, reference, options.threads);
  result.all = {summarise(forward), summarise(nearestDistances(reference, samples.points, options.threads))};

  const std::vector<Vector<3>> near = samples.within(2.0);
  if (near.empty()) return result;
  std::size_t kept = 0;  // the distances of the near samples are among those of all
  for (std::size_t i = 0; i < forward.size(); ++i)
    if (samples.mahalanobis[i] <= 2.0) forward[kept++] = forward[i];
  forward.resize(kept);
  result.within_two_sigma = {summarise(std::move(forward)),
                             summarise(nearestDistances(reference, near, options.threads))};
  return result;
}

}  // namespace gaussmap
