// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/pi.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "gaussmap/sensor/range_image.h"
#include "mapping/moving/default_lengths.h"

namespace gaussmap {
using namespace detail;

namespace {

enum class PointState : char {
  Occupied,  // the map has a cell there, or the point is not finite
  Unknown,   // the map has no cell there
  Free
};

/// Pixels of 1 degree. Narrower pixels would stay empty between the means of coarse cells, and wider ones would hide
/// the gaps between objects.
SphericalProjection mapProjection() {
  constexpr int kRows = 180;
  SphericalProjection projection;
  projection.columns = 2 * kRows;
  for (int row = 0; row <= kRows; ++row) projection.row_borders.push_back(kPi * (double(row) / kRows - 0.5));
  return projection;
}

/// Adds the means of the leaves in a cell to an image. The axes of the image are those of the map. Skips free clusters
/// and cells farther from the sensor than `reach` [m].
void addMeans(const GaussianMap<3>& map, std::size_t cell, int scale, const Eigen::Vector3d& sensor, double reach,
              float threshold, RangeImage& image) {
  const double side = map.grid().side(scale);
  const Eigen::Vector3d centre = map.grid().centre(map.scale(scale).keys[cell], scale);
  if ((centre - sensor).norm() - 0.5 * std::sqrt(3.0) * side > reach) return;
  if (!map.isLeaf(cell, scale)) {
    const IndexRange children = map.childCells(cell, scale);
    for (std::size_t child = children.first; child < children.last; ++child)
      addMeans(map, child, scale - 1, sensor, reach, threshold, image);
    return;
  }
  const IndexRange range = map.gaussiansOf(cell, scale);
  for (std::size_t i = range.first; i < range.last; ++i)
    if (map.logOdds(i, scale) >= threshold) image.add(map.gaussian(i, scale).mean - sensor);
}

/// Frees the unknown points that are connected to free points. Points are connected if their cubes of side `link` [m]
/// are adjacent, over at most kSteps cubes.
void growFreePoints(const std::vector<Eigen::Vector3d>& points, double link, std::vector<PointState>& states) {
  constexpr int kSteps = 4;
  using Cube = std::array<double, 3>;  // whole numbers; a double holds those of any point
  std::vector<std::pair<Cube, std::size_t>> cubes;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (states[i] == PointState::Occupied) continue;
    const Eigen::Vector3d cube = (points[i] / link).array().floor();
    cubes.push_back({{cube.x(), cube.y(), cube.z()}, i});
  }
  std::sort(cubes.begin(), cubes.end());
  std::vector<std::size_t> front;  // first entries of cubes
  std::vector<bool> reached(cubes.size(), false);
  const auto reach = [&](std::size_t first) {
    if (reached[first]) return;
    reached[first] = true;
    front.push_back(first);
    for (std::size_t i = first; i < cubes.size() && cubes[i].first == cubes[first].first; ++i)
      states[cubes[i].second] = PointState::Free;
  };
  for (std::size_t first = 0, next = 0; first < cubes.size(); first = next) {
    bool has_free = false;
    for (next = first; next < cubes.size() && cubes[next].first == cubes[first].first; ++next)
      has_free = has_free || states[cubes[next].second] == PointState::Free;
    if (has_free) reach(first);
  }
  for (int step = 0; step < kSteps; ++step)
    for (const std::size_t from : std::exchange(front, {}))
      for (int neighbour = 0; neighbour < 27; ++neighbour) {
        const Cube& at = cubes[from].first;
        const int x = neighbour % 3 - 1, y = neighbour / 3 % 3 - 1, z = neighbour / 9 - 1;
        const Cube wanted{at[0] + x, at[1] + y, at[2] + z};
        const auto found = std::lower_bound(cubes.begin(), cubes.end(), std::pair{wanted, std::size_t{0}});
        if (found != cubes.end() && found->first == wanted) reach(static_cast<std::size_t>(found - cubes.begin()));
      }
}

/// Frees the unknown points in front of the surfaces of the map, and the unknown points connected to them.
void freeUnknownPoints(const GaussianMap<3>& map, const std::vector<Eigen::Vector3d>& points,
                       const Eigen::Vector3d& sensor, const FreePointOptions& options,
                       std::vector<PointState>& states) {
  // Limits the time in a large map. A sensor that sees 100 m farther than the points does not need more.
  constexpr double kBehind = 100.0;
  double farthest = 0.0;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) farthest = std::max(farthest, (point - sensor).norm());
  RangeImage image{Projection(mapProjection())};
  const int top = map.scales() - 1;
  for (std::size_t cell = 0; cell < map.cellCount(top); ++cell)
    addMeans(map, cell, top, sensor, farthest + kBehind, options.threshold, image);
  const double side = map.grid().side(0);
  const VisibilityOptions visibility = forCells(options.visibility, side);
  parallelFor(points.size(), options.threads, 1024, [&](std::size_t i) {
    if (states[i] != PointState::Unknown) return;
    if (visibilityOf(image, points[i] - sensor, visibility) == Visibility::PassedThrough) states[i] = PointState::Free;
  });
  growFreePoints(points, *forCells(MovingCellOptions(), side).link, states);
}

}  // namespace

std::vector<bool> freePoints(const GaussianMap<3>& map, const std::vector<Eigen::Vector3d>& points,
                             const Eigen::Vector3d& sensor, const FreePointOptions& options) {
  std::vector<PointState> states(points.size(), PointState::Occupied);
  parallelFor(points.size(), options.threads, 1024, [&](std::size_t i) {
    if (!points[i].allFinite()) return;
    const auto log_odds = logOddsAt<3>(map, points[i]);
    states[i] = !log_odds                       ? PointState::Unknown
                : *log_odds < options.threshold ? PointState::Free
                                                : PointState::Occupied;
  });
  if (options.unknown == UnknownSpace::Automatic && !map.empty() &&
      std::find(states.begin(), states.end(), PointState::Unknown) != states.end()) {
    if (!sensor.allFinite()) throw std::invalid_argument("the position of the sensor is not finite");
    freeUnknownPoints(map, points, sensor, options, states);
  }
  std::vector<bool> free(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    free[i] =
        states[i] == PointState::Free || (states[i] == PointState::Unknown && options.unknown == UnknownSpace::Remove);
  return free;
}

}  // namespace gaussmap
