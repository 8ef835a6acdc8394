// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/refine.h"
#include "points/nearest_distances.h"
#include "viewer/colouring.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::vector<double> gaussianErrors(const GaussianMap<3>& map, int scale, const std::vector<Vector<3>>& reference) {
  const std::size_t count = map.gaussianCount(scale);
  if (count == 0 || (reference.empty() && scale == 0)) return std::vector<double>(count, kNone);
  std::vector<Vector<3>> detail;
  if (reference.empty())
    for (const GaussianId& id : leaves(map)) detail.push_back(map.gaussian(id.index, id.scale).mean);

  SampleOptions options;
  options.share = SampleShare::Mass;
  const MapSamples<3> samples = sampleMap(map, scale, options);
  const std::vector<double> distances = nearestDistances(samples.points, reference.empty() ? detail : reference);
  std::vector<double> sums(count, 0.0), numbers(count, 0.0);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    sums[samples.gaussian[i]] += distances[i];
    numbers[samples.gaussian[i]] += 1.0;
  }
  for (std::size_t i = 0; i < count; ++i) sums[i] = numbers[i] > 0.0 ? sums[i] / numbers[i] : kNone;
  return sums;
}

std::vector<double> contributions(const GaussianMap<3>& map, int scale) {
  if (scale + 1 == map.scales()) return std::vector<double>(map.gaussianCount(scale), kNone);
  return cellErrors(map, scale + 1).contributions;
}

std::vector<double> errorsOfCells(const GaussianMap<3>& map, int scale) {
  std::vector<double> errors(map.gaussianCount(scale), kNone);
  if (scale == 0) return errors;
  const std::vector<double> cells = cellErrors(map, scale).cells;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    for (std::size_t i = map.gaussiansOf(cell, scale).first; i < map.gaussiansOf(cell, scale).last; ++i)
      errors[i] = cells[cell];
  return errors;
}

}  // namespace gaussmap
