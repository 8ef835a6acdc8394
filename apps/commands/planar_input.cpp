// SPDX-License-Identifier: BSD-3-Clause
#include "commands/planar_input.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/core/error.h"

namespace gaussmap::app {
namespace {

/// Calls convert(scan). Throws FileError with the name of the scan in place of std::invalid_argument.
template <typename Convert>
Scan converted(const Scans& scans, std::size_t index, const Convert& convert) {
  try {
    return convert(scans.read(index));
  } catch (const std::invalid_argument& error) {
    throw FileError(scans.info(index).name, error.what());
  }
}

}  // namespace

Option addSlice(Command& command, Slice& slice) {
  return command
      .numbers("--slice", slice, 2, -1e6, 1e6,
               "for planar maps: use only points of 3-D scans between these two heights in the map frame [m]")
      .onePerUse();
}

void checkSlice(const Slice& slice) {
  if (slice.size() == 2 && slice[0] > slice[1]) throw UsageError("--slice: the second height is below the first");
}

PlanarScanOptions planarOptions(const Slice& slice, const AccumulateOptions& limits) {
  checkSlice(slice);
  PlanarScanOptions options;
  options.max_range = limits.max_range;
  options.min_range = limits.min_range;
  options.crop = limits.crop;
  if (slice.empty()) return options;
  options.slice = true;
  options.z_min = slice[0];
  options.z_max = slice[1];
  return options;
}

AccumulateOptions withSlice(AccumulateOptions limits, const Slice& slice, const std::vector<double>& crop) {
  checkSlice(slice);
  if (crop.size() == 6)
    throw UsageError("--crop: a planar map has no heights; give x0 y0 x1 y1, and --slice Z0 Z1 for heights");
  if (slice.empty()) return limits;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (!limits.crop) limits.crop = Box<3>{{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  limits.crop->low.z() = slice[0];
  limits.crop->high.z() = std::nextafter(slice[1], kFar);  // a box excludes its high corner, a slice includes it
  return limits;
}

Scan levelScan(const Scans& scans, std::size_t index, const Slice& slice) {
  const PlanarScanOptions options = planarOptions(slice, {});
  return converted(scans, index, [&](const Scan& scan) { return detail::levelled(scan, options); });
}

Scan sweepOf(const Scans& scans, std::size_t index, const Slice& slice, double min_range) {
  if (slice.empty()) return levelScan(scans, index, slice);
  PlanarScanOptions options = planarOptions(slice, {});
  options.min_range = min_range;
  return converted(scans, index, [&](const Scan& scan) { return detail::scanOfBeams(planarScan(scan, options)); });
}

}  // namespace gaussmap::app
