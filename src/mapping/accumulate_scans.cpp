// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/accumulate_scans.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "core/check.h"
#include "core/parallel.h"
#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kBlocksPerTask = 128;  // 65,536 points

PointCounts& operator+=(PointCounts& a, const PointCounts& b) {
  a.read += b.read;
  a.accepted += b.accepted;
  a.non_finite += b.non_finite;
  a.at_sensor += b.at_sensor;
  a.beyond_range += b.beyond_range;
  return a;
}

bool isFinitePoint(const PointBlock<3>& block, std::size_t i) {
  return std::isfinite(block.coordinate[0][i]) && std::isfinite(block.coordinate[1][i]) &&
         std::isfinite(block.coordinate[2][i]);
}

void checkOptions(const AccumulateOptions& options) {
  require(options.max_range >= 0.0, "max_range", options.max_range, "must not be negative");
}

/// Takes out the points that are none and moves the others into the map frame.
PointCounts acceptPoints(const ScanSource& scan, const AccumulateOptions& options, PointBlock<3>& block) {
  const bool in_sensor_frame = options.frame == ScanFrame::Sensor;
  const Eigen::Vector3d origin = in_sensor_frame ? Eigen::Vector3d::Zero() : scan.pose.translation;
  double square_range[PointBlock<3>::kCapacity];
  for (std::size_t i = 0; i < block.size; ++i) {
    const double x = block.coordinate[0][i] - origin.x(), y = block.coordinate[1][i] - origin.y(),
                 z = block.coordinate[2][i] - origin.z();
    square_range[i] = x * x + y * y + z * z;
  }
  const double most = options.max_range * options.max_range;
  PointCounts counts;
  counts.read = static_cast<std::int64_t>(block.size);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < block.size; ++i) {
    for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][kept] = block.coordinate[axis][i];
    // The square of a number may be infinite.
    const bool finite = std::isfinite(square_range[i]) || isFinitePoint(block, i),
               at_sensor = in_sensor_frame && square_range[i] == 0.0, too_far = finite && square_range[i] > most;
    counts.non_finite += !finite;
    counts.at_sensor += at_sensor;
    counts.beyond_range += too_far;
    kept += finite && !at_sensor && !too_far;
  }
  block.size = kept;
  counts.accepted = static_cast<std::int64_t>(kept);
  if (in_sensor_frame) transform(scan.pose, block);
  return counts;
}

/// Runs body(first) on the blocks of a scan, several at a time: the number of open scans stays that of the threads.
template <typename Body>
void forBlocks(const PcdReader& reader, int threads, const Body& body) {
  const std::size_t step = kBlocksPerTask * PointBlock<3>::kCapacity;
  const std::size_t tasks = (reader.size() + step - 1) / step;
  parallelForWithin(tasks, threads, [&](std::size_t index) {
    const std::size_t last = std::min(reader.size(), (index + 1) * step);
    for (std::size_t first = index * step; first < last; first += PointBlock<3>::kCapacity) body(first);
  });
}

/// Sums and counts of one thread.
struct Partial {
  MomentGrid<3> moments;
  PointCounts counts;
};
using Partials = tbb::enumerable_thread_specific<Partial>;

/// Counts the points of all scans; full(partial) is called after every block, by the thread whose sums they are.
template <typename Full>
void accumulate(const std::vector<ScanSource>& scans, const AccumulateOptions& options, Partials& partials,
                const Full& full, const std::function<void(const AccumulateProgress&)>& progress) {
  checkOptions(options);
  std::mutex progress_mutex;
  AccumulateProgress done{0, scans.size(), 0, 0};
  parallelFor(scans.size(), options.threads, 1, [&](std::size_t index) {
    const ScanSource& scan = scans[index];
    const PcdReader reader(scan.path);
    forBlocks(reader, options.threads, [&](std::size_t first) {
      Partial& partial = partials.local();
      PointBlock<3> block;
      reader.read(first, block);
      partial.counts += acceptPoints(scan, options, block);
      try {
        if (partial.moments.add(block) != block.size) throw std::out_of_range("a point too far for doubles");
      } catch (const std::out_of_range& error) {
        throw std::out_of_range(scan.path.string() + ": " + error.what());
      }
      full(partial);
    });
    reader.requireWhole();
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    ++done.scans_done;
    done.points += static_cast<std::int64_t>(reader.size());
    done.cells = std::max(done.cells, partials.local().moments.size());
    progress(done);
  });
}

}  // namespace

AccumulatedScans accumulateScans(const std::vector<ScanSource>& scans, const AccumulateOptions& options,
                                 const std::function<void(const AccumulateProgress&)>& progress) {
  Partials partials([&] { return Partial{MomentGrid<3>(options.resolution), {}}; });
  accumulate(
      scans, options, partials, [](const Partial&) {}, progress);
  AccumulatedScans all{MomentGrid<3>(options.resolution), {}};
  for (Partial& partial : partials) {
    all.counts += partial.counts;
    if (partial.moments.size() > all.moments.size()) std::swap(partial.moments, all.moments);
    all.moments.merge(partial.moments, options.threads);
  }
  return all;
}

PointCounts accumulateScansInParts(const std::vector<ScanSource>& scans, const AccumulateOptions& options,
                                   std::size_t most_bytes, const std::function<void(const MomentGrid<3>&)>& take,
                                   const std::function<void(const AccumulateProgress&)>& progress) {
  Partials partials([&] { return Partial{MomentGrid<3>(options.resolution), {}}; });
  const auto threads = static_cast<std::size_t>(threadCount(options.threads));
  std::mutex mutex;
  const auto hand_over = [&](Partial& partial) {
    if (partial.moments.empty()) return;
    const std::lock_guard lock(mutex);
    take(partial.moments);
    partial.moments = MomentGrid<3>(options.resolution);
  };
  accumulate(
      scans, options, partials,
      [&](Partial& partial) {
        if (partial.moments.memoryBytes() > most_bytes / threads) hand_over(partial);
      },
      progress);
  PointCounts counts;
  for (Partial& partial : partials) {
    counts += partial.counts;
    hand_over(partial);
  }
  return counts;
}

std::vector<Vector<3>> readScans(const std::vector<ScanSource>& scans, const AccumulateOptions& options) {
  checkOptions(options);
  std::vector<Vector<3>> points;
  for (const ScanSource& scan : scans) {
    const PcdReader reader(scan.path);
    forBlocks(reader, 1, [&](std::size_t first) {
      PointBlock<3> block;
      reader.read(first, block);
      acceptPoints(scan, options, block);
      for (std::size_t i = 0; i < block.size; ++i)
        points.emplace_back(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
    });
    reader.requireWhole();
  }
  return points;
}

}  // namespace gaussmap
