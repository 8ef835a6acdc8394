// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/online/online_mapper.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/accept_points.h"
#include "core/check.h"
#include "map/map_scale_builder.h"
#include "mapping/moving/check_options.h"
#include "mapping/moving/default_lengths.h"
#include "mapping/online/online_state.h"

namespace gaussmap {
using namespace detail;

namespace {

void checkOptions(const OnlineOptions& options) {
  require(options.slowest_rate > 0.0 && options.slowest_rate <= 1.0, "slowest_rate", options.slowest_rate,
          "must be above 0 and at most 1");
  require(options.fastest_rate >= options.slowest_rate && options.fastest_rate <= 1.0, "fastest_rate",
          options.fastest_rate, "must be at least slowest_rate and at most 1");
  require(options.occupancy.max_log_odds > 0.0, "max_log_odds", options.occupancy.max_log_odds, "must be positive");
  require(options.max_samples >= 0, "max_samples", options.max_samples, "must not be negative");
  require(std::abs(options.forget_below) <= options.occupancy.max_log_odds, "forget_below", options.forget_below,
          "must be between -max_log_odds and max_log_odds");
  require(options.occupancy_every >= 1, "occupancy_every", options.occupancy_every, "must be at least 1");
  require(options.look_back >= 0, "look_back", options.look_back, "must not be negative");
  require(options.refine_every >= 0, "refine_every", options.refine_every, "must not be negative");
  checkLimits(limitsOf(options));
  require(options.budget >= 1.0, "budget", options.budget, "must be at least 1");
  MovingCellOptions objects;
  objects.occupancy = options.occupancy;
  objects.link = options.link;
  objects.reach = options.reach;
  detail::checkOptions(objects, options.map.resolution);
  detail::checkOptions(options.shared, options.map.resolution);
  ScanEvidenceOptions views;
  views.visibility = options.visibility;
  views.projection = options.projection;
  views.no_return_is_free = options.no_return_is_free;
  detail::checkOptions(views);
}

/// Returns the options with all lengths set.
OnlineOptions withLengths(OnlineOptions options) {
  const double side = options.map.resolution;
  options.visibility = forCells(options.visibility, side);
  options.shared = forCells(options.shared, side);
  MovingCellOptions objects;
  objects.link = options.link;
  objects.reach = options.reach;
  objects = forCells(objects, side);
  options.link = objects.link;
  options.reach = objects.reach;
  return options;
}

/// Measures the seconds since the last call of lap().
class StopWatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

template <int D>
std::vector<Vector<D>> returnsInMap(const Scan& scan) {
  const Eigen::Matrix3d rotation = scan.pose.rotation.toRotationMatrix();
  std::vector<Vector<D>> points;
  points.reserve(scan.points.size());
  for (const Eigen::Vector3d& point : scan.points)
    if (isReturn(point)) points.push_back((rotation * point + scan.pose.translation).template head<D>());
  return points;
}

}  // namespace

OnlineOptions OnlineOptions::yguel2009(int dimensions) {
  if (dimensions != 2 && dimensions != 3)
    throw std::invalid_argument("dimensions = " + std::to_string(dimensions) + ": must be 2 or 3");
  OnlineOptions options;
  options.map.resolution = dimensions == 2 ? 0.05 : 0.1;
  options.map.ratio = 10;
  options.map.scales = 3;
  options.learning_rate = LearningRate::Occupancy;
  options.slowest_rate = 5e-4;
  options.fastest_rate = 5e-2;
  options.occupancy.max_log_odds = 10.0;
  options.hit_rule = HitRule::RangeImage;
  options.samples = OccupancySamples::Random;
  options.sample_range = SampleRange::CellCentre;
  options.max_samples = 0;
  options.occupancy_every = dimensions == 2 ? 1 : 3;
  options.look_back = 0;  // new cells are not tested against earlier scans
  options.reach = 0.0;    // objects do not grow beyond the deleted cells
  options.refine_every = 10;
  options.refine_cells = 4;
  options.method = RefineMethod::Insert;
  options.seed_rule = ClusterSeed::InputGaussian;
  options.refine_area = RefineArea::Visible;
  options.error_factor = ErrorFactor::OneMinusRate;
  return options;
}

template <int D>
struct OnlineMapper<D>::State {
  State(const OnlineOptions& given, Removed told)
      : options(withLengths(given)), cells(Grid<D>(given.map)), removed(std::move(told)) {
    checkOptions(options);
    options.map = cells.grid().options();
  }

  OnlineOptions options;
  OnlineCells<D> cells;
  Removed removed;
  std::deque<SensorView> views;    // the last look_back range images, oldest first
  std::deque<ScanSums<D>> recent;  // moments of the last look_back scans, oldest first
  std::uint32_t scans = 0;

  std::optional<Projection> found;  // projection found in an earlier scan
  double found_fill = 0.0;          // filled pixels per return of that scan
  int found_columns = 0;            // columns of that scan

  std::optional<RangeImage> imageOf(const Scan& scan, std::size_t returns);
  GaussianMap<D> freeze();
};

/// Returns the range image of a scan, or std::nullopt if no projection is found. A projection is kept while it fits the
/// scans: at least 199 of 200 returns are in view, and the filled pixels per return change by at most a fifth.
template <int D>
std::optional<RangeImage> OnlineMapper<D>::State::imageOf(const Scan& scan, std::size_t returns) {
  const auto fill = [](const RangeImage& image) {
    return double(image.filledPixels()) / std::max(1.0, double(image.returns()));
  };
  if (options.projection) return RangeImage(*options.projection, scan.points);
  if (found && found_columns == scan.columns) {
    RangeImage image(*found, scan.points);
    const bool in_view = double(image.returns()) >= 0.995 * double(returns);
    if (in_view && std::abs(fill(image) - found_fill) <= 0.2 * found_fill) return image;
  }
  found = findProjection(scan.points, scan.columns);
  if (!found) return std::nullopt;
  RangeImage image(*found, scan.points);
  found_fill = fill(image);
  found_columns = scan.columns;
  return image;
}

template <int D>
OnlineMapper<D>::OnlineMapper(const OnlineOptions& options, Removed removed)
    : state_(std::make_unique<State>(options, std::move(removed))) {}

template <int D>
OnlineMapper<D>::~OnlineMapper() = default;
template <int D>
OnlineMapper<D>::OnlineMapper(OnlineMapper&&) noexcept = default;
template <int D>
OnlineMapper<D>& OnlineMapper<D>::operator=(OnlineMapper&&) noexcept = default;

template <int D>
OnlineStatistics OnlineMapper<D>::add(Scan scan) {
  State& state = *state_;
  const OnlineOptions& options = state.options;
  OnlineStatistics statistics;
  StopWatch watch;
  const PointLimits limits = limitsOf(options);
  Scan beams;  // what the range image shows: also points that are too near or outside the box
  const bool differs = limits.min_range > 0.0 || limits.crops;
  if (differs) {
    beams = scan;
    PointLimits far;
    far.max_range = limits.max_range;
    dropPoints(far, beams);
  }
  statistics.points = dropPoints(limits, scan);
  OnlineScan<D> now;
  now.number = state.scans;
  now.pose = scan.pose;
  now.points = returnsInMap<D>(scan);
  updateByPoints(state.cells, now, options);
  ++state.scans;
  statistics.cells_touched = now.touched.size();
  statistics.cells_new = now.new_cells.size();
  statistics.update_time = watch.lap();

  const bool look_around = now.number % static_cast<std::uint32_t>(options.occupancy_every) == 0;
  if (options.hit_rule == HitRule::Points)
    countHits(state.cells, now, look_around ? now.touched : now.new_cells, options);
  std::optional<RangeImage> image;
  if (look_around || options.look_back > 0) {
    const Scan& shown = differs ? beams : scan;
    const auto returns = std::count_if(shown.points.begin(), shown.points.end(), isReturn);
    image = state.imageOf(shown, static_cast<std::size_t>(returns));
  }
  if (image) {
    SensorView view(*std::move(image), scan.pose);
    if (options.no_return_is_free) view.image.noReturnIsFree(*options.no_return_is_free);
    statistics.image_time = watch.lap();
    lookBack(state.cells, now, state.views, options);
    statistics.look_back_time = watch.lap();
    if (look_around) testVisible(state.cells, now, view, options, statistics);
    statistics.occupancy_time = watch.lap();
    state.views.push_back(std::move(view));
    while (state.views.size() > static_cast<std::size_t>(options.look_back)) state.views.pop_front();
  }
  if (options.forget) {
    const std::vector<GoneCell<D>> gone = forget(state.cells, now, options, state.removed, statistics);
    if (now.sums && options.look_back > 0) {
      state.recent.push_back({now.number, *std::move(now.sums)});
      splitSharedCells(state.cells, now, gone, state.recent, options, state.removed, statistics);
      while (state.recent.size() > static_cast<std::size_t>(options.look_back)) state.recent.pop_front();
    }
  }
  statistics.forget_time = watch.lap();
  if (options.refine_every > 0 && state.scans % static_cast<std::uint32_t>(options.refine_every) == 0)
    refineVisible(state.cells, now, options, statistics);
  statistics.refine_time = watch.lap();
  return statistics;
}

template <int D>
GaussianMap<D> OnlineMapper<D>::State::freeze() {
  const bool exact = options.learning_rate == LearningRate::SampleMean;
  const int top = cells.scales() - 1;
  if (exact && top > 0)
    for (std::uint32_t i = 0; i < cells.slots(top); ++i)
      if (cells.cell(i, top).alive) cells.refresh(i, top);

  std::vector<MapScale<D>> scales(static_cast<std::size_t>(cells.scales()));
  std::vector<std::uint32_t> order;   // slots of the next coarser scale, in key order
  std::vector<std::uint32_t> starts;  // first Gaussian per slot of that scale
  for (int scale = top; scale >= 0; --scale) {
    MapScaleBuilder<D> out;
    std::vector<std::uint32_t> here;
    if (scale == top) {
      for (std::uint32_t i = 0; i < cells.slots(top); ++i)
        if (cells.cell(i, top).alive) here.push_back(i);
      std::sort(here.begin(), here.end(),
                [&](auto a, auto b) { return cells.cell(a, top).key < cells.cell(b, top).key; });
    } else {
      std::vector<std::uint32_t>& first_child = scales[static_cast<std::size_t>(scale) + 1].first_child;
      for (const std::uint32_t parent : order) {
        first_child.push_back(static_cast<std::uint32_t>(here.size()));
        const std::vector<std::uint32_t>& children = cells.cell(parent, scale + 1).children;
        here.insert(here.end(), children.begin(), children.end());
        std::sort(here.end() - static_cast<std::ptrdiff_t>(children.size()), here.end(),
                  [&](auto a, auto b) { return cells.cell(a, scale).key < cells.cell(b, scale).key; });
      }
      first_child.push_back(static_cast<std::uint32_t>(here.size()));
    }
    std::vector<std::uint32_t> own_starts(cells.slots(scale));
    for (const std::uint32_t i : here) {
      const OnlineCell<D>& cell = cells.cell(i, scale);
      out.addCell(cell.key);
      own_starts[i] = static_cast<std::uint32_t>(out.gaussians());
      for (const OnlineCluster<D>& cluster : cell.clusters) {
        if (scale == 0 && exact)
          out.addMoments(cells.moments(i));
        else
          out.addGaussian(cluster.gaussian);
        out.addLogOdds(cluster.log_odds);
        if (scale < top) out.addParent(starts[cell.parent] + cluster.parent);
      }
    }
    scales[static_cast<std::size_t>(scale)] = out.take();
    order = std::move(here);
    starts = std::move(own_starts);
  }
  return GaussianMap<D>(options.map, std::move(scales));
}

template <int D>
GaussianMap<D> OnlineMapper<D>::map() const {
  return state_->freeze();
}

template <int D>
void OnlineMapper<D>::restore(const RemovedCluster<D>& removed) {
  if (removed.scale != 0)
    throw std::invalid_argument("scale " + std::to_string(removed.scale) +
                                ": only clusters of scale 0 can be restored; coarser clusters are computed from them");
  restoreCell(state_->cells, removed, state_->options);
}

template <int D>
std::size_t OnlineMapper<D>::scans() const {
  return state_->scans;
}

template <int D>
const OnlineOptions& OnlineMapper<D>::options() const {
  return state_->options;
}

template <int D>
std::size_t OnlineMapper<D>::memoryBytes() const {
  std::size_t bytes = state_->cells.memoryBytes();
  for (const SensorView& view : state_->views)
    bytes += static_cast<std::size_t>(view.image.rows()) * static_cast<std::size_t>(view.image.columns()) *
             sizeof(PixelRanges);
  for (const ScanSums<D>& scan : state_->recent) bytes += scan.sums.memoryBytes();
  return bytes;
}

template class OnlineMapper<2>;
template class OnlineMapper<3>;

}  // namespace gaussmap
