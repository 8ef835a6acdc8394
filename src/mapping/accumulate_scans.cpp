// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/build.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/accept_points.h"
#include "core/parallel.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kBlocksPerTask = 128;  // 65,536 points

/// Calls body(first) for every block of a scan, in parallel. The number of open scans does not exceed the number of
/// threads.
template <typename Body>
void forBlocks(const ScanReader& reader, int threads, const Body& body) {
  const std::size_t step = kBlocksPerTask * PointBlock<3>::kCapacity;
  const std::size_t tasks = (reader.size() + step - 1) / step;
  parallelForWithin(tasks, threads, [&](std::size_t index) {
    const std::size_t last = std::min(reader.size(), (index + 1) * step);
    for (std::size_t first = index * step; first < last; first += PointBlock<3>::kCapacity) body(first);
  });
}

/// Returns the accepted points of a block in D dimensions, map frame.
const PointBlock<3>& pointsOf(const PointBlock<3>& block, PointBlock<3>&) {
  return block;
}
const PointBlock<2>& pointsOf(const PointBlock<3>& block, PointBlock<2>& planar) {
  planar.size = block.size;
  for (int axis = 0; axis < 2; ++axis) std::copy_n(block.coordinate[axis], block.size, planar.coordinate[axis]);
  return planar;
}

/// The moments and counts of each thread.
template <int D>
using Partials = tbb::enumerable_thread_specific<AccumulatedScans<D>>;

template <int D>
Partials<D> emptyPartials(double resolution) {
  return Partials<D>([resolution] { return AccumulatedScans<D>{MomentGrid<D>(resolution), {}}; });
}

/// Adds the points of all scans to `partials`. After every block, the thread calls full(partial) with its own partial.
template <int D, typename Full>
void accumulate(const Scans& scans, const AccumulateOptions& options, Partials<D>& partials, const Full& full,
                const ReportProgress& progress) {
  const PointLimits limits = limitsOf(options);
  checkLimits(limits);
  std::mutex progress_mutex;
  AccumulateProgress done{0, scans.size(), 0, 0};
  parallelFor(scans.size(), options.threads, 1, [&](std::size_t index) {
    const ScanInfo scan = scans.info(index);
    const std::unique_ptr<ScanReader> reader = scans.open(index);
    forBlocks(*reader, options.threads, [&](std::size_t first) {
      AccumulatedScans<D>& partial = partials.local();
      PointBlock<3> block;
      PointBlock<D> flat;
      reader->read(first, block);
      partial.counts += acceptPoints(scan.pose, scans.frame(), limits, block);
      try {
        if (partial.moments.add(pointsOf(block, flat)) != block.size)
          throw std::out_of_range("a point is not finite in the map frame; check the units and the pose");
      } catch (const std::out_of_range& error) {
        throw std::out_of_range(scan.name + ": " + error.what());
      }
      full(partial);
    });
    reader->requireWhole();
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    ++done.scans_done;
    done.points += static_cast<std::int64_t>(reader->size());
    done.cells = std::max(done.cells, partials.local().moments.size());
    progress(done);
  });
}

}  // namespace

template <int D>
AccumulatedScans<D> accumulateScans(const Scans& scans, const AccumulateOptions& options,
                                    const ReportProgress& progress) {
  Partials<D> partials = emptyPartials<D>(options.resolution);
  accumulate<D>(
      scans, options, partials, [](const AccumulatedScans<D>&) {}, progress);
  AccumulatedScans<D> all{MomentGrid<D>(options.resolution), {}};
  for (AccumulatedScans<D>& partial : partials) {
    all.counts += partial.counts;
    if (partial.moments.size() > all.moments.size()) std::swap(partial.moments, all.moments);
    all.moments.merge(partial.moments, options.threads);
  }
  return all;
}

template <int D>
PointCounts accumulateScansInParts(const Scans& scans, const AccumulateOptions& options, std::size_t max_bytes,
                                   const typename AccumulatedScans<D>::TakePart& take, const ReportProgress& progress) {
  Partials<D> partials = emptyPartials<D>(options.resolution);
  const auto threads = static_cast<std::size_t>(threadCount(options.threads));
  std::mutex mutex;
  const auto hand_over = [&](AccumulatedScans<D>& partial) {
    if (partial.moments.empty()) return;
    const std::lock_guard lock(mutex);
    take(partial.moments);
    partial.moments = MomentGrid<D>(options.resolution);
  };
  accumulate<D>(
      scans, options, partials,
      [&](AccumulatedScans<D>& partial) {
        if (partial.moments.memoryBytes() > max_bytes / threads) hand_over(partial);
      },
      progress);
  PointCounts counts;
  for (AccumulatedScans<D>& partial : partials) {
    counts += partial.counts;
    hand_over(partial);
  }
  return counts;
}

template <int D>
std::vector<Vector<D>> readPoints(const Scans& scans, const AccumulateOptions& options) {
  const PointLimits limits = limitsOf(options);
  checkLimits(limits);
  std::vector<Vector<D>> points;
  for (std::size_t index = 0; index < scans.size(); ++index) {
    const ScanInfo scan = scans.info(index);
    const std::unique_ptr<ScanReader> reader = scans.open(index);
    forBlocks(*reader, 1, [&](std::size_t first) {
      PointBlock<3> block;
      reader->read(first, block);
      acceptPoints(scan.pose, scans.frame(), limits, block);
      for (std::size_t i = 0; i < block.size; ++i) {
        points.emplace_back();
        for (int axis = 0; axis < D; ++axis) points.back()(axis) = block.coordinate[axis][i];
      }
    });
    reader->requireWhole();
  }
  return points;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                   \
  template AccumulatedScans<D> accumulateScans<D>(const Scans&, const AccumulateOptions&, const ReportProgress&); \
  template PointCounts accumulateScansInParts<D>(const Scans&, const AccumulateOptions&, std::size_t,             \
                                                 const AccumulatedScans<D>::TakePart&, const ReportProgress&);    \
  template std::vector<Vector<(D)>> readPoints<D>(const Scans&, const AccumulateOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
