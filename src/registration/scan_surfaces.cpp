// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_surfaces.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/morton.h"
#include "core/quantile.h"

namespace gaussmap::detail {
namespace {

constexpr double kSideLimit = 2097152.0;  // 2^21 cells per axis, see mortonCode()
constexpr int kFewestPoints = 5;          // of a piece; three points always lie in a plane

/// Sums of the points of a cell, relative to the corner of the grid.
struct CellSums {
  int count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
};

/// Returns the piece of a cell with these points, or nullopt if they are too few or not flat.
std::optional<Surface> surfaceOf(const CellSums& cell, double side, const std::optional<Eigen::Vector3d>& plane) {
  if (cell.count < kFewestPoints) return std::nullopt;
  const double n = cell.count;
  Surface surface;
  surface.mean = cell.sum / n;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(cell.squares / n - surface.mean * surface.mean.transpose());
  const Eigen::Vector3d spread = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();  // in ascending order
  // The spread of a full square is 0.29 of its side. A line of points (one ring of a lidar) has no normal.
  const int thin = plane ? 1 : 0;
  if (spread(thin) > 0.1 * side || spread(thin + 1) < 0.1 * side || spread(thin) > 0.4 * spread(thin + 1))
    return std::nullopt;
  surface.across = plane.value_or(Eigen::Vector3d::Zero());
  surface.normal = plane ? plane->cross(eigen.eigenvectors().col(2)).normalized() : eigen.eigenvectors().col(0);
  surface.thickness = spread(thin);
  return surface;
}

}  // namespace

ScanSurfaces::ScanSurfaces(const std::vector<Eigen::Vector3d>& points, double finest,
                           const std::optional<Eigen::Vector3d>& plane)
    : finest_(finest), planar_(plane.has_value()) {
  if (points.empty()) return;
  // The points lie around the middle of the cells of the coarsest level, so that a plane through the centre is not cut.
  corner_ = medianOf(points) - Eigen::Vector3d::Constant((kSideLimit / 2 + 0.37) * finest);
  MortonItems items, spare;
  items.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = (points[i] - corner_) / finest;
    if ((cell.array() >= 0.0).all() && (cell.array() < kSideLimit).all())
      items.push_back(
          {mortonCode(std::uint64_t(cell.x()), std::uint64_t(cell.y()), std::uint64_t(cell.z())), std::uint32_t(i)});
  }
  sortByCode(items.data(), items.size(), spare);

  const Eigen::Vector3d middle = corner_ + Eigen::Vector3d::Constant(kSideLimit / 2 * finest);
  std::array<CellSums, kLevels> open;
  std::array<std::size_t, kLevels> first{};  // index of the first piece inside the open cell of a level
  const auto close = [&](int level, std::uint64_t code) {
    if (std::optional<Surface> surface = surfaceOf(open[std::size_t(level)], finest * double(1 << level), plane)) {
      surface->mean += middle;
      surface->level = level;
      surface->covered = surfaces_.size() > first[std::size_t(level)];
      cells_[std::size_t(level)].push_back({code, std::uint32_t(surfaces_.size())});
      surfaces_.push_back(*surface);
    }
    open[std::size_t(level)] = CellSums();
    first[std::size_t(level)] = surfaces_.size();
  };
  for (std::size_t i = 0; i < items.size(); ++i) {
    const std::uint64_t code = items[i].code;
    const Eigen::Vector3d point = points[items[i].index] - middle;
    const Eigen::Matrix3d square = point * point.transpose();
    for (CellSums& cell : open) {
      ++cell.count;
      cell.sum += point;
      cell.squares += square;
    }
    const std::uint64_t next = i + 1 < items.size() ? items[i + 1].code : ~code;
    for (int level = 0; level < kLevels && (code >> 3 * level) != (next >> 3 * level); ++level)
      close(level, code >> 3 * level);
  }
}

const Surface* ScanSurfaces::at(const Eigen::Vector3d& point, int level) const {
  const Eigen::Vector3d cell = (point - corner_) / finest_;
  if (!((cell.array() >= 0.0).all() && (cell.array() < kSideLimit).all())) return nullptr;
  const std::uint64_t code =
      mortonCode(std::uint64_t(cell.x()), std::uint64_t(cell.y()), std::uint64_t(cell.z())) >> 3 * level;
  const std::vector<Entry>& cells = cells_[std::size_t(level)];
  const auto found = std::lower_bound(cells.begin(), cells.end(), code,
                                      [](const Entry& entry, std::uint64_t wanted) { return entry.code < wanted; });
  return found != cells.end() && found->code == code ? &surfaces_[found->index] : nullptr;
}

Eigen::Vector3d medianOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d centre;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < points.size(); ++i) values[i] = points[i](axis);
    centre(axis) = nthSmallest(values, values.size() / 2);
  }
  return centre;
}

double medianDistance(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& centre) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const Eigen::Vector3d& point : points) values.push_back((point - centre).norm());
  return nthSmallest(values, values.size() / 2);
}

std::optional<Eigen::Vector3d> planeOf(const std::vector<Eigen::Vector3d>& points, double extent) {
  const Eigen::Vector3d centre = medianOf(points);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d p = (point - centre) / extent;
    sum += p;
    squares += p * p.transpose();
  }
  const double n = double(points.size());
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.compute(squares / n - sum * sum.transpose() / (n * n));
  if (!(eigen.eigenvalues()(0) < 1e-6)) return std::nullopt;
  return eigen.eigenvectors().col(0);
}

}  // namespace gaussmap::detail
