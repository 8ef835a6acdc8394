// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/column_samples.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {

bool wholeWithin(const ColumnSample& sample, double low, double high) {
  return sample.numeric && std::all_of(sample.values.begin(), sample.values.end(), [&](double value) {
           return value >= low && value <= high && value == std::floor(value);
         });
}

bool isWhole(const ColumnSample& sample) {
  return std::all_of(sample.values.begin(), sample.values.end(),
                     [](double value) { return !std::isfinite(value) || value == std::floor(value); });
}

Extent extentOf(const ColumnSample& sample) {
  Extent extent;
  bool is_first = true;
  for (const double value : sample.values) {
    if (!std::isfinite(value)) continue;
    extent.low = is_first ? value : std::min(extent.low, value);
    extent.high = is_first ? value : std::max(extent.high, value);
    is_first = false;
  }
  return extent;
}

bool areNormals(const std::vector<ColumnSample>& samples, std::size_t first) {
  constexpr double kTolerance = 0.02;  // normals are often written with two decimals
  bool found = false;
  for (std::size_t i = 0; i < samples[first].values.size(); ++i) {
    const double x = samples[first].values[i], y = samples[first + 1].values[i], z = samples[first + 2].values[i];
    const double norm = std::sqrt(x * x + y * y + z * z);
    if (std::isnan(norm) || norm == 0.0) continue;
    if (std::abs(norm - 1.0) > kTolerance) return false;
    found = true;
  }
  return found && samples[first].numeric && samples[first + 1].numeric && samples[first + 2].numeric;
}

bool areColours(const std::vector<ColumnSample>& samples, std::size_t first) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!wholeWithin(samples[first + i], 0.0, 255.0)) return false;
  return !areNormals(samples, first);
}

bool areColourFractions(const std::vector<ColumnSample>& samples, std::size_t first) {
  for (std::size_t i = 0; i < 3; ++i) {
    const ColumnSample& sample = samples[first + i];
    if (!sample.numeric || !std::all_of(sample.values.begin(), sample.values.end(),
                                        [](double value) { return value >= 0.0 && value <= 1.0; }))
      return false;
  }
  return !areNormals(samples, first);
}

}  // namespace gaussmap::detail
