// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/scan_evidence.h"

#include <algorithm>
#include <stdexcept>

#include "core/accept_points.h"
#include "core/check.h"
#include "core/parallel.h"
#include "gaussmap/core/scans.h"
#include "mapping/moving/check_options.h"
#include "mapping/moving/map_cells.h"
#include "sensor/culling.h"
#include "sensor/default_lengths.h"

namespace gaussmap::detail {
namespace {

/// The observations of one scan. They are added up later in the order of the scans.
struct OneScan {
  std::vector<std::size_t> hits, misses;  // finest cells
  VisitCounts counts;
  bool is_camera = false;
};

std::vector<std::size_t> cellsOf(const Scan& scan, const GaussianMap<3>& map, const PointLimits& limits) {
  std::vector<std::size_t> cells;
  for (const Eigen::Vector3d& point : scan.points) {
    if (!limits.isInRange(point)) continue;
    const Eigen::Vector3d in_map = scan.pose * point;
    if (!limits.isInside(in_map)) continue;
    const CellKey<3> key = map.grid().keyOf(in_map);
    if (!cells.empty() && map.scale(0).keys[cells.back()] == key) continue;
    if (const auto cell = map.find(key, 0)) cells.push_back(*cell);
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

OneScan lookAround(const GaussianMap<3>& map, const std::vector<Eigen::Vector3d>& means, const Scan& scan,
                   const ScanEvidenceOptions& options) {
  OneScan result;
  result.hits = cellsOf(scan, map, limitsOf(options));
  const std::optional<Projection> projection =
      options.projection ? options.projection : findProjection(scan.points, scan.columns);
  if (!projection) return result;
  result.is_camera = std::holds_alternative<PlanarProjection>(*projection);
  RangeImage image(*projection, scan.points);
  if (options.no_return_is_free) image.noReturnIsFree(*options.no_return_is_free);
  const Culling culling(image, options.visibility);
  const Eigen::Matrix3d to_sensor = scan.pose.rotation.toRotationMatrix().transpose();
  result.counts = visitVisible(MapCells{map}, culling, scan.pose, [&](std::size_t cell) {
    const Eigen::Vector3d mean = to_sensor * (means[cell] - scan.pose.translation);
    if (visibilityOf(image, mean, options.visibility) == Visibility::PassedThrough) result.misses.push_back(cell);
  });
  return result;
}

std::vector<Eigen::Vector3d> finestMeans(const GaussianMap<3>& map) {
  std::vector<Eigen::Vector3d> means(map.cellCount(0));
  for (std::size_t i = 0; i < means.size(); ++i) means[i] = map.gaussian(i, 0).mean;
  return means;
}

}  // namespace

void checkOptions(const ScanEvidenceOptions& options) {
  checkLimits(limitsOf(options));
  const double tolerance = toleranceOf(options.visibility), clearance = clearanceOf(options.visibility);
  const double spacing = spacingOf(options.visibility);
  require(tolerance >= 0.0, "tolerance", tolerance, "must not be negative");
  require(clearance >= 0.0, "clearance", clearance, "must not be negative");
  require(spacing >= 0.0, "spacing", spacing, "must not be negative");
  if (options.visibility.noise) {
    const DepthNoise& noise = *options.visibility.noise;
    require(noise.constant >= 0.0, "noise.constant", noise.constant, "must not be negative");
    require(noise.growth >= 0.0, "noise.growth", noise.growth, "must not be negative");
    require(noise.start >= 0.0, "noise.start", noise.start, "must not be negative");
  }
  if (options.projection) checkProjection(*options.projection);
  if (options.no_return_is_free) {
    const double range = *options.no_return_is_free;
    require(range > 0.0 && range <= std::numeric_limits<float>::max(), "no_return_is_free", range,
            "must be positive and finite");
  }
}

ScanEvidence gatherEvidence(const GaussianMap<3>& map, const Scans& scans, const ScanEvidenceOptions& given,
                            const std::function<void(std::size_t)>& progress) {
  checkOptions(given);
  ScanEvidenceOptions options = given;
  options.visibility = forCells(given.visibility, map.grid().side(0));
  constexpr std::size_t kBatch = 16;  // scans in memory at a time
  const std::vector<Eigen::Vector3d> means = finestMeans(map);
  ScanEvidence evidence;
  evidence.cells.resize(means.size());
  for (std::size_t first = 0; first < scans.size(); first += kBatch) {
    std::vector<OneScan> batch(std::min(kBatch, scans.size() - first));
    parallelFor(batch.size(), options.threads, 1, [&](std::size_t i) {
      const Scan scan = scans.read(first + i);
      try {
        batch[i] = lookAround(map, means, scan, options);
      } catch (const std::out_of_range& error) {
        throw std::out_of_range(scans.info(first + i).name + ": " + error.what());
      }
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const OneScan& scan = batch[i];
      for (const std::size_t cell : scan.hits) evidence.cells[cell].hit(static_cast<std::uint32_t>(first + i));
      auto hit = scan.hits.begin();
      for (const std::size_t cell : scan.misses) {
        hit = std::lower_bound(hit, scan.hits.end(), cell);
        if (hit == scan.hits.end() || *hit != cell) evidence.cells[cell].miss();
      }
      evidence.camera_scans += scan.is_camera;
      evidence.cells_tested += scan.counts.tested;
      evidence.cells_visited += scan.counts.visited;
    }
    if (progress) progress(first + batch.size());
  }
  return evidence;
}

}  // namespace gaussmap::detail
