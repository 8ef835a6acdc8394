// SPDX-License-Identifier: BSD-3-Clause
#include "papers/editing.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "clock.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/editing/merge_maps.h"
#include "gaussmap/editing/simplify.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "points/nearest_distances.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

constexpr std::size_t kSamples = 50000;
constexpr double kMaxError = 0.1;  // of the compression [m]

template <typename Work>
double secondsOf(const Work& work) {
  const double start = benchmark::processorSeconds();
  work();
  return benchmark::processorSeconds() - start;
}

GaussianMap<3> mapOf(const Sequence<3>& sequence, std::size_t first, std::size_t last) {
  const auto at = [&](std::size_t i) { return sequence.scans.begin() + static_cast<std::ptrdiff_t>(i); };
  RefineOptions options;
  options.threads = 1;
  return refine<3>(build<3>(MemoryScans(std::vector<Scan>(at(first), at(last))), sequence.map), PerCell{3.0}, options)
      .map;
}

EditedRow rowOf(const std::string& step, const std::string& method, const GaussianMap<3>& map, int scale,
                const Sequence<3>& sequence, double seconds) {
  return {step, method, map.gaussianCount(scale),
          distancesOf(map, scale, kSamples, sequence, sequence.scans.size()).all, seconds};
}

void merge(const Sequence<3>& sequence, std::vector<EditedRow>& rows) {
  const std::size_t half = sequence.scans.size() / 2;
  const GaussianMap<3> a = mapOf(sequence, 0, half), b = mapOf(sequence, half, sequence.scans.size());
  const GaussianMap<3> whole = mapOf(sequence, 0, sequence.scans.size());
  MergeMapsOptions own, printed = MergeMapsOptions::yguel2009();
  own.threads = printed.threads = 1;
  GaussianMap<3> by_own, by_printed;
  const double own_seconds = secondsOf([&] { by_own = mergeMaps<3>(a, b, own); });
  const double printed_seconds = secondsOf([&] { by_printed = mergeMaps<3>(a, b, printed); });
  for (int scale = sequence.map.scales - 1; scale > 0; --scale) {
    const std::string step = "two halves merged, scale " + std::to_string(scale);
    rows.push_back(rowOf(step, "as printed", by_printed, scale, sequence, printed_seconds));
    rows.push_back(rowOf(step, "default", by_own, scale, sequence, own_seconds));
    rows.push_back(rowOf(step, "map of all scans", whole, scale, sequence, 0.0));
  }
}

void simplifyMap(const Sequence<3>& sequence, const GaussianMap<3>& map, std::vector<EditedRow>& rows) {
  SimplifyOptions own, printed = SimplifyOptions::yguel2009();
  own.threads = printed.threads = 1;
  GaussianMap<3> by_own, by_printed;
  const double own_seconds = secondsOf([&] { by_own = simplify<3>(map, PerCell{1.5}, own).map; });
  const double printed_seconds = secondsOf([&] { by_printed = simplify<3>(map, PerCell{1.5}, printed).map; });
  for (int scale = sequence.map.scales - 1; scale > 0; --scale) {
    const std::string step = "simplified from 3 x to 1.5 x, scale " + std::to_string(scale);
    rows.push_back(rowOf(step, "as printed", by_printed, scale, sequence, printed_seconds));
    rows.push_back(rowOf(step, "default", by_own, scale, sequence, own_seconds));
  }
}

EditedRow leavesOf(const std::string& method, const GaussianMap<3>& map, const Sequence<3>& sequence, double seconds) {
  SampleOptions sampling;
  sampling.samples = kSamples;
  sampling.at_least = 1;
  sampling.threads = 1;
  const std::vector<Vector<3>> points = sampleLeaves<3>(map, sampling).points;
  const std::vector<double> distances = sequence.mesh
                                            ? meshDistances(points, *sequence.mesh, 1)
                                            : nearestDistances(points, sequence.points(sequence.scans.size()), 1);
  return {"compressed, leaves", method, leaves(map).size(), summarise(distances), seconds};
}

/// Compresses by eq. (6) to at most as many leaves as the default has.
void compressMap(const Sequence<3>& sequence, const GaussianMap<3>& map, std::vector<EditedRow>& rows) {
  CompressOptions own, printed = CompressOptions::yguel2009();
  own.threads = printed.threads = 1;
  GaussianMap<3> by_own, by_printed;
  const double own_seconds = secondsOf([&] { by_own = compress<3>(map, kMaxError, own); });
  const std::size_t most = leaves(by_own).size();
  double low = 1e-3, high = 1e9, seconds = 0.0;  // squared standard deviations
  while (high / low > 1.01) {
    const double limit = std::sqrt(low * high);
    seconds = secondsOf([&] { by_printed = compress<3>(map, limit, printed); });
    (leaves(by_printed).size() > most ? low : high) = limit;
  }
  rows.push_back(
      leavesOf("as printed, eq. (6) <= " + number(high), compress<3>(map, high, printed), sequence, seconds));
  rows.push_back(leavesOf("default, " + number(kMaxError) + " m", by_own, sequence, own_seconds));
}

}  // namespace

std::vector<EditedRow> runEditing(const Sequence<3>& sequence) {
  std::vector<EditedRow> rows;
  merge(sequence, rows);
  const GaussianMap<3> map = mapOf(sequence, 0, sequence.scans.size());
  simplifyMap(sequence, map, rows);
  compressMap(sequence, map, rows);
  return rows;
}

void reportEditing(const std::vector<std::pair<std::string, std::vector<EditedRow>>>& data, Report& report) {
  report.heading(2, "Yguel, abstract and section 5.4: merging, simplifying and compressing");
  std::vector<std::vector<std::string>> cells;
  for (const auto& [name, rows] : data)
    for (const EditedRow& row : rows) {
      const DistanceSummary& to = row.distances;
      cells.push_back({name, row.step, row.method, std::to_string(row.gaussians), number(to.max), number(to.q99),
                       number(to.q95), number(to.mean), row.seconds > 0.0 ? number(row.seconds) : "-"});
    }
  report.table({"data", "map", "method", "Gaussians", "maximum [m]", "99 %", "95 %", "mean", "processor time [s]"},
               cells);
  // The printed method beside the row after it, which is the default.
  struct Ratio {
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    void add(double value) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
    std::string text() const { return times(low) == times(high) ? times(low) : times(low) + " to " + times(high); }
  };
  const auto claimOf = [&](const std::string& step, const std::string& place, const std::string& words) {
    Ratio mean, time;
    for (const auto& [name, rows] : data)
      for (std::size_t i = 0; i + 1 < rows.size(); ++i)
        if (rows[i].step.rfind(step, 0) == 0 && rows[i].method.rfind("as printed", 0) == 0) {
          mean.add(rows[i].distances.mean / rows[i + 1].distances.mean);
          time.add(rows[i].seconds / rows[i + 1].seconds);
        }
    report.claim(
        {"Yguel", place, words,
         "as printed, divided by the default: mean distance " + mean.text() + ", processor time " + time.text(),
         mean.high < 1.1  ? "True, and as accurate as our default."
         : mean.low > 1.1 ? "True, but the result is less accurate than that of our default."
                          : "True. On some of the data, the result is as accurate as that of our default; on "
                            "the rest, it is less accurate."});
  };
  claimOf("two halves", "sec. 5.4", "Two maps are merged cell by cell, without access to the finer scales");
  claimOf("simplified", "sec. 5.4", "The same process simplifies a map");
  claimOf(
      "compressed", "abstract, sec. 1",
      "Finer clusters are deleted where the error of the coarse cell, eq. (6), is low (compared at equal numbers of "
      "Gaussians)");
}

}  // namespace gaussmap::papers
