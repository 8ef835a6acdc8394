// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/moving/moving_points.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "core/accept_points.h"
#include "core/parallel.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/mapping/build.h"
#include "mapping/moving/check_options.h"
#include "mapping/moving/default_lengths.h"
#include "mapping/moving/moving_cells.h"
#include "mapping/moving/scan_evidence.h"
#include "mapping/moving/shared_cells.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr int kRatio = 6, kScales = 3;  // the coarser scales are used only for culling

}  // namespace

struct MovingPoints::State {
  std::shared_ptr<const Scans> scans;
  MovingPointOptions options;
  PointLimits limits;
  PointCounts counts;
  GaussianMap<3> map;
  ScanEvidence evidence;
  std::vector<bool> moving;
  SharedCells shared;

  /// Returns the cell of a point and sets `in_map` to the point in the map frame. Returns std::nullopt if the map was
  /// built without the point.
  std::optional<std::size_t> cellOf(const Scan& scan, std::size_t i, Eigen::Vector3d& in_map) const {
    const Eigen::Vector3d& point = scan.points[i];
    if (!limits.isInRange(point)) return std::nullopt;
    in_map = scan.pose * point;
    if (!limits.isInside(in_map)) return std::nullopt;
    return map.find(map.grid().keyOf(in_map), 0);
  }

  /// Returns the moments of the points in shared cells from the scans that did not see the object. `progress` is called
  /// with the number of scans done.
  MomentGrid<3> stillPoints(const std::function<void(std::size_t)>& progress) const;
};

MomentGrid<3> MovingPoints::State::stillPoints(const std::function<void(std::size_t)>& progress) const {
  tbb::enumerable_thread_specific<MomentGrid<3>> partials([&] { return MomentGrid<3>(map.grid().side(0)); });
  std::mutex progress_mutex;
  std::size_t done = 0;
  parallelFor(scans->size(), options.evidence.threads, 1, [&](std::size_t index) {
    const Scan scan = scans->read(index);
    std::vector<Vector<3>> points;
    Eigen::Vector3d in_map;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const auto cell = cellOf(scan, i, in_map);
      if (!cell || moving[*cell]) continue;
      const auto entry = shared.find(*cell);
      if (entry != shared.end() && (index < entry->second.first_scan || index > entry->second.last_scan))
        points.push_back(in_map);
    }
    partials.local().addPoints(points);
    if (!progress) return;
    const std::lock_guard lock(progress_mutex);
    progress(++done);
  });
  MomentGrid<3> all(map.grid().side(0));
  for (const MomentGrid<3>& partial : partials) all.merge(partial, options.evidence.threads);
  return all;
}

MovingPoints::MovingPoints(std::shared_ptr<const Scans> scans, const MovingPointOptions& options,
                           const std::function<void(MovingPointStep, std::size_t)>& progress)
    : state_(std::make_unique<State>()) {
  const MapOptions grid{options.resolution, kRatio, kScales, 0.0};
  State& state = *state_;
  state.map = GaussianMap<3>(grid);
  checkOptions(options.evidence);
  checkOptions(options.cells, options.resolution);
  checkOptions(options.shared, options.resolution);
  state.scans = std::move(scans);
  state.options = options;
  state.options.shared = forCells(options.shared, options.resolution);
  state.limits = limitsOf(options.evidence);
  const ScanEvidenceOptions& input = options.evidence;
  const auto report = [&](MovingPointStep step) -> std::function<void(std::size_t)> {
    if (!progress) return {};
    return [&progress, step](std::size_t done) { progress(step, done); };
  };

  const auto counting = report(MovingPointStep::Counting);
  const AccumulateOptions reading{options.resolution, input.max_range, input.threads, input.min_range, input.crop};
  AccumulatedScans accumulated = accumulateScans(*state.scans, reading, [&](const AccumulateProgress& counted) {
    if (counting) counting(counted.scans_done);
  });
  state.counts = accumulated.counts;
  state.map = build<3>(accumulated.moments, grid);
  state.evidence = gatherEvidence(state.map, *state.scans, input, report(MovingPointStep::Looking));
  MovingCellOptions cells = options.cells;
  if (state.evidence.camera_scans > 0) cells.min_points = std::max(cells.min_points, cells.min_points_of_camera);
  state.moving = findMovingCells(state.map, state.evidence.cells, cells);
  state.shared = findSharedCells(state.map, state.moving, state.evidence.cells);
  fitSurfaces(state.map, state.stillPoints(report(MovingPointStep::Sharing)), options.shared, input.threads,
              state.shared);
}

MovingPoints::~MovingPoints() = default;
MovingPoints::MovingPoints(MovingPoints&&) noexcept = default;
MovingPoints& MovingPoints::operator=(MovingPoints&&) noexcept = default;

const Scans& MovingPoints::scans() const {
  return *state_->scans;
}
const PointCounts& MovingPoints::counts() const {
  return state_->counts;
}
const GaussianMap<3>& MovingPoints::map() const {
  return state_->map;
}
const ScanEvidence& MovingPoints::evidence() const {
  return state_->evidence;
}
const std::vector<bool>& MovingPoints::movingCells() const {
  return state_->moving;
}

std::vector<bool> MovingPoints::inScan(std::size_t index) const {
  const State& state = *state_;
  const Scan scan = state.scans->read(index);
  std::vector<bool> flags(scan.points.size());
  Eigen::Vector3d in_map;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const auto cell = state.cellOf(scan, i, in_map);
    if (!cell) continue;
    flags[i] = state.moving[*cell];
    const auto entry = state.shared.find(*cell);
    if (entry == state.shared.end() || !entry->second.surface || index < entry->second.first_scan ||
        index > entry->second.last_scan)
      continue;
    const Surface<3>& surface = *entry->second.surface;
    const Eigen::Vector3d about_centre = in_map - state.map.grid().centre(state.map.scale(0).keys[*cell], 0);
    flags[i] = std::abs(surface.normal.dot(about_centre - surface.point)) > surface.thickness(state.options.shared);
  }
  return flags;
}

}  // namespace gaussmap
