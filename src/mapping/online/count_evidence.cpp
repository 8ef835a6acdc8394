// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/pi.h"
#include "gaussmap/core/gaussian.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// Input and result of a test of a cluster against a range image.
struct BeamTest {
  std::uint32_t cell;
  std::uint32_t cluster;
  int scale;
  Eigen::Vector3d mean;     // [m, map frame], copied here while the cell is in the CPU cache
  float passed = 0.0f;      // result: fraction of the samples that beams passed through
  float at_surface = 0.0f;  // result: fraction of the samples at the surface that the beams hit
};

/// Gives visitVisible() access to the cells. Adds the coarse cells whose children are visited to `seen`.
template <int D>
struct VisibleCells {
  const OnlineCells<D>& cells;
  const Pose& sensor;
  const std::vector<double>& max_ranges;
  std::vector<std::vector<std::uint32_t>>& seen;  // per scale
  std::vector<std::uint32_t> roots;

  VisibleCells(const OnlineCells<D>& all, const Pose& pose, const std::vector<double>& ranges,
               std::vector<std::vector<std::uint32_t>>& found)
      : cells(all), sensor(pose), max_ranges(ranges), seen(found) {
    const int top = cells.scales() - 1;
    for (std::uint32_t i = 0; i < cells.slots(top); ++i)
      if (cells.cell(i, top).alive && inReach(i, top)) roots.push_back(i);
  }

  int scales() const { return cells.scales(); }
  std::size_t rootCount() const { return roots.size(); }
  std::uint32_t indexOf(std::size_t i, int scale) const {
    return scale == scales() - 1 ? roots[i] : static_cast<std::uint32_t>(i);
  }
  Eigen::Vector3d centre(std::size_t i, int scale) const {
    return inSpace(cells.grid().centre(cells.cell(indexOf(i, scale), scale).key, scale), sensor);
  }
  double radius(int scale) const { return 0.5 * std::sqrt(double(D)) * cells.grid().side(scale); }
  bool inReach(std::uint32_t i, int scale) const {
    const auto s = static_cast<std::size_t>(scale);
    if (s >= max_ranges.size()) return true;
    const Eigen::Vector3d middle = inSpace(cells.grid().centre(cells.cell(i, scale).key, scale), sensor);
    return (middle - sensor.translation).norm() - radius(scale) <= max_ranges[s];
  }
  template <typename Body>
  void forChildren(std::size_t i, int scale, const Body& body) const {
    const std::uint32_t coarse = indexOf(i, scale);
    seen[static_cast<std::size_t>(scale)].push_back(coarse);
    for (const std::uint32_t child : cells.cell(coarse, scale).children)
      if (inReach(child, scale - 1)) body(child);
  }
};

template <int D>
BeamTest beamTest(const OnlineCells<D>& cells, std::uint32_t i, std::uint32_t cluster, int scale, const Pose& sensor) {
  const OnlineCell<D>& cell = cells.cell(i, scale);
  return {i, cluster, scale,
          inSpace(Vector<D>(cells.grid().centre(cell.key, scale) + cell.clusters[cluster].gaussian.mean), sensor)};
}

Visibility lookAt(const Eigen::Vector3d& point, const SensorView& view, const OnlineOptions& options) {
  return visibilityOf(view.image, view.toSensor(point), options.visibility);
}

/// Tests the mean of a cluster.
void testMean(BeamTest& test, const SensorView& view, const OnlineOptions& options) {
  const Visibility seen = lookAt(test.mean, view, options);
  test.passed = seen == Visibility::PassedThrough ? 1.0f : 0.0f;
  test.at_surface = seen == Visibility::AtSurface ? 1.0f : 0.0f;
}

/// Tests random samples of a cluster. Rejects samples outside its cell. If none is left, tests the mean instead.
template <int D>
void testSamples(const OnlineCells<D>& cells, BeamTest& test, const SensorView& view, const OnlineOptions& options) {
  const OnlineCell<D>& cell = cells.cell(test.cell, test.scale);
  const Gaussian<D>& gaussian = cell.clusters[test.cluster].gaussian;
  const Vector<D> centre = cells.grid().centre(cell.key, test.scale);
  const double side = cells.grid().side(test.scale);
  const Eigen::Vector3d place = options.sample_range == SampleRange::Mean ? test.mean : inSpace(centre, view.pose);
  const double most = options.max_samples > 0 ? options.max_samples : double(view.image.rows()) * view.image.columns();
  const int wanted = samplesFor(view.image.projection(), view.toSensor(place).norm(), side, most);
  Random random = Random::forPart(0, (std::uint64_t{KeyIndex::hashOf(cell.key)} << 16) + test.cluster);
  const GaussianSampler<D> sampler(gaussian);
  int inside = 0, passed = 0, at_surface = 0;
  for (int i = 0; i < wanted; ++i) {
    const Vector<D> point = sampler(random);
    if (point.cwiseAbs().maxCoeff() > 0.5 * side) continue;
    ++inside;
    const Visibility seen = lookAt(inSpace(Vector<D>(centre + point), view.pose), view, options);
    passed += seen == Visibility::PassedThrough;
    at_surface += seen == Visibility::AtSurface;
  }
  if (inside == 0) return testMean(test, view, options);
  test.passed = static_cast<float>(double(passed) / inside);
  test.at_surface = static_cast<float>(double(at_surface) / inside);
}

template <int D>
void runTests(const OnlineCells<D>& cells, std::vector<BeamTest>& tests, const SensorView& view,
              const OnlineOptions& options) {
  const bool mean_only = options.samples == OccupancySamples::Mean;
  // A coarse cell close to the sensor can have thousands of samples, so the parts are small.
  parallelFor(tests.size(), options.threads, mean_only ? 1024 : 16, [&](std::size_t i) {
    if (mean_only)
      testMean(tests[i], view, options);
    else
      testSamples(cells, tests[i], view, options);
  });
}

template <int D>
void countPassed(OnlineCells<D>& cells, const std::vector<BeamTest>& tests, const OnlineOptions& options,
                 OnlineScan<D>& scan) {
  for (const BeamTest& test : tests) {
    if (!(test.passed > 0.0f)) continue;
    miss(cells.cell(test.cell, test.scale).clusters[test.cluster], double(test.passed), options.occupancy);
    if (test.scale == 0) scan.missed.push_back(test.cell);
  }
}

/// HitRule::RangeImage: changes each cluster by the mean over its samples. A scan that raises the log-odds counts as a
/// hit, a scan that lowers them as a miss.
template <int D>
void countChanges(OnlineCells<D>& cells, const std::vector<BeamTest>& tests, const OnlineOptions& options,
                  OnlineScan<D>& scan) {
  const double most = options.occupancy.max_log_odds;
  for (const BeamTest& test : tests) {
    OnlineCluster<D>& cluster = cells.cell(test.cell, test.scale).clusters[test.cluster];
    const double change =
        double(test.at_surface) * options.occupancy.hit - double(test.passed) * options.occupancy.miss;
    if (change > 0.0) cluster.evidence.hit(scan.number);
    if (change < 0.0) cluster.evidence.miss();
    if (change < 0.0 && test.scale == 0) scan.missed.push_back(test.cell);
    cluster.log_odds = static_cast<float>(std::clamp(double(cluster.log_odds) + change, -most, most));
  }
}

}  // namespace

int samplesFor(const Projection& projection, double range, double side, double most) {
  double pixel = 0.0;  // area of a pixel on the unit sphere (lidar) or on the plane z = 1 (camera)
  if (const auto* lidar = std::get_if<SphericalProjection>(&projection)) {
    const double rows = double(lidar->row_borders.size()) - 1.0;
    pixel = (lidar->row_borders.back() - lidar->row_borders.front()) / rows * 2.0 * kPi / lidar->columns;
  } else {
    const auto& camera = std::get<PlanarProjection>(projection);
    pixel = 1.0 / (camera.fx * camera.fy);
  }
  const double count = 3.0 * kPi / (4.0 * pixel) * std::pow(side / range, 2);
  return static_cast<int>(std::clamp(std::ceil(count), 1.0, most));
}

template <int D>
void countHits(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<std::uint32_t>& touched,
               const OnlineOptions& options) {
  for (const std::uint32_t finest : touched) {
    std::uint32_t cell = finest, cluster = 0;
    for (int scale = 0; scale < cells.scales(); ++scale) {
      OnlineCluster<D>& at = cells.cell(cell, scale).clusters[cluster];
      // The scan has counted a hit for this cluster, and so for its ancestors.
      if (scale > 0 && at.evidence.hits > 0 && at.evidence.last_hit == scan.number) break;
      hit(at, scan.number, options.occupancy);
      cluster = at.parent;
      cell = cells.cell(cell, scale).parent;
    }
  }
}

template <int D>
void lookBack(OnlineCells<D>& cells, OnlineScan<D>& scan, const std::deque<SensorView>& views,
              const OnlineOptions& options) {
  for (const SensorView& view : views) {
    std::vector<BeamTest> tests;
    for (const std::uint32_t cell : scan.new_cells) tests.push_back(beamTest(cells, cell, 0, 0, view.pose));
    runTests(cells, tests, view, options);
    countPassed(cells, tests, options, scan);
  }
}

template <int D>
void testVisible(OnlineCells<D>& cells, OnlineScan<D>& scan, const SensorView& view, const OnlineOptions& options,
                 OnlineStatistics& statistics) {
  std::vector<std::vector<std::uint32_t>> seen(static_cast<std::size_t>(cells.scales()));
  const Culling culling(view.image, options.visibility);
  const VisibleCells<D> visible(cells, view.pose, options.max_ranges, seen);
  const bool by_image = options.hit_rule == HitRule::RangeImage;
  const auto isTested = [&](const OnlineCluster<D>& cluster) {
    return by_image || cluster.evidence.hits == 0 || cluster.evidence.last_hit != scan.number;
  };
  std::vector<BeamTest> tests;
  const auto may = [&](const Eigen::Vector3d& centre, double radius) {
    return by_image ? culling.maySee(centre, radius) : culling.mayPassThrough(centre, radius);
  };
  const VisitCounts counts = visitCells(visible, view.pose, may, [&](std::size_t cell) {
    const std::uint32_t i = visible.indexOf(cell, 0);
    if (isTested(cells.cell(i, 0).clusters[0])) tests.push_back(beamTest(cells, i, 0, 0, view.pose));
  });
  statistics.cells_tested = counts.tested;
  statistics.cells_visited = counts.visited;
  for (int scale = 1; scale < cells.scales(); ++scale)
    for (const std::uint32_t i : seen[static_cast<std::size_t>(scale)]) {
      OnlineClusters<D>& clusters = cells.cell(i, scale).clusters;
      if (std::none_of(clusters.begin(), clusters.end(), isTested)) continue;
      if (options.learning_rate == LearningRate::SampleMean) cells.refresh(i, scale);
      for (std::uint32_t c = 0; c < clusters.size(); ++c)
        if (isTested(clusters[c])) tests.push_back(beamTest(cells, i, c, scale, view.pose));
    }
  runTests(cells, tests, view, options);
  if (by_image)
    countChanges(cells, tests, options, scan);
  else
    countPassed(cells, tests, options, scan);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                    \
  template void countHits<D>(OnlineCells<D>&, const OnlineScan<D>&, const std::vector<std::uint32_t>&,             \
                             const OnlineOptions&);                                                                \
  template void lookBack<D>(OnlineCells<D>&, OnlineScan<D>&, const std::deque<SensorView>&, const OnlineOptions&); \
  template void testVisible<D>(OnlineCells<D>&, OnlineScan<D>&, const SensorView&, const OnlineOptions&,           \
                               OnlineStatistics&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
