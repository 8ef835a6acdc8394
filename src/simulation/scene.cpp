// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "core/pi.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kMostSurfacePoints = 1e9;

/// Two unit vectors that make a right-handed frame with a direction.
std::pair<Eigen::Vector3d, Eigen::Vector3d> across(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d first = axis.unitOrthogonal();
  return {first, axis.normalized().cross(first)};
}

std::size_t tiles(double length, double spacing) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(length / spacing)));
}

/// Middle of tile i of n over [0, 1].
double middle(std::size_t i, std::size_t n) {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(n);
}

void append(const Rectangle& rectangle, double spacing, std::vector<Eigen::Vector3d>& points) {
  const std::size_t across_u = tiles(rectangle.u.norm(), spacing), across_v = tiles(rectangle.v.norm(), spacing);
  for (std::size_t i = 0; i < across_u; ++i)
    for (std::size_t j = 0; j < across_v; ++j)
      points.emplace_back(rectangle.corner + middle(i, across_u) * rectangle.u + middle(j, across_v) * rectangle.v);
}

void append(const Cylinder& cylinder, double spacing, std::vector<Eigen::Vector3d>& points) {
  const auto [first, second] = across(cylinder.axis);
  const std::size_t along = tiles(cylinder.axis.norm(), spacing), around = tiles(2 * kPi * cylinder.radius, spacing);
  for (std::size_t i = 0; i < along; ++i) {
    for (std::size_t j = 0; j < around; ++j) {
      const double angle = 2 * kPi * middle(j, around);
      points.emplace_back(cylinder.base + middle(i, along) * cylinder.axis +
                          cylinder.radius * (std::cos(angle) * first + std::sin(angle) * second));
    }
  }
}

[[noreturn]] void refuse(const char* kind, std::size_t index, const char* what) {
  throw std::invalid_argument(std::string(kind) + " " + std::to_string(index) + " of the scene " + what);
}

void keepNearer(std::optional<double>& nearest, const std::optional<double>& range) {
  if (range && (!nearest || *range < *nearest)) nearest = range;
}

}  // namespace

std::optional<double> intersect(const Ray& ray, const Rectangle& rectangle) {
  const Eigen::Vector3d normal = rectangle.u.cross(rectangle.v);
  const double approach = normal.dot(ray.direction);
  if (approach == 0.0) return std::nullopt;
  const double range = normal.dot(rectangle.corner - ray.origin) / approach;
  if (!(range > 0.0)) return std::nullopt;
  const Eigen::Vector3d offset = ray.origin + range * ray.direction - rectangle.corner;
  const double s = offset.dot(rectangle.u), t = offset.dot(rectangle.v);
  if (s < 0.0 || s > rectangle.u.squaredNorm() || t < 0.0 || t > rectangle.v.squaredNorm()) return std::nullopt;
  return range;
}

std::optional<double> intersect(const Ray& ray, const Cylinder& cylinder) {
  const double length = cylinder.axis.norm();
  const Eigen::Vector3d axis = cylinder.axis / length, offset = ray.origin - cylinder.base;
  const double origin_along = offset.dot(axis), direction_along = ray.direction.dot(axis);
  const Eigen::Vector3d origin_across = offset - origin_along * axis;
  const Eigen::Vector3d direction_across = ray.direction - direction_along * axis;
  // |origin_across + r direction_across|^2 = radius^2, that is a r^2 + 2 b r + c = 0
  const double a = direction_across.squaredNorm(), b = origin_across.dot(direction_across);
  if (a == 0.0) return std::nullopt;
  // The ray's nearest point to the axis instead of b^2 - a c, which cancels for far origins.
  const double missed_by = (origin_across - b / a * direction_across).squaredNorm();
  const double inside = cylinder.radius * cylinder.radius - missed_by;
  if (inside < 0.0) return std::nullopt;
  const double half_chord = std::sqrt(inside / a);
  for (const double range : {-b / a - half_chord, -b / a + half_chord}) {
    const double along = origin_along + range * direction_along;
    if (range > 0.0 && along >= 0.0 && along <= length) return range;
  }
  return std::nullopt;
}

double distance(const Eigen::Vector3d& point, const Rectangle& rectangle) {
  const Eigen::Vector3d offset = point - rectangle.corner;
  const double s = std::clamp(offset.dot(rectangle.u) / rectangle.u.squaredNorm(), 0.0, 1.0);
  const double t = std::clamp(offset.dot(rectangle.v) / rectangle.v.squaredNorm(), 0.0, 1.0);
  return (offset - s * rectangle.u - t * rectangle.v).norm();
}

double distance(const Eigen::Vector3d& point, const Cylinder& cylinder) {
  const Eigen::Vector3d offset = point - cylinder.base;
  const double along = offset.dot(cylinder.axis) / cylinder.axis.squaredNorm();
  const double beyond = (along - std::clamp(along, 0.0, 1.0)) * cylinder.axis.norm();
  return std::hypot(beyond, (offset - along * cylinder.axis).norm() - cylinder.radius);
}

double Scene::distance(const Eigen::Vector3d& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Rectangle& rectangle : rectangles) nearest = std::min(nearest, gaussmap::distance(point, rectangle));
  for (const Cylinder& cylinder : cylinders) nearest = std::min(nearest, gaussmap::distance(point, cylinder));
  return nearest;
}

std::optional<double> Scene::intersect(const Ray& ray) const {
  std::optional<double> nearest;
  for (const Rectangle& rectangle : rectangles) keepNearer(nearest, gaussmap::intersect(ray, rectangle));
  for (const Cylinder& cylinder : cylinders) keepNearer(nearest, gaussmap::intersect(ray, cylinder));
  return nearest;
}

Scene Scene::transformed(const Pose& pose) const {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  Scene moved = *this;
  for (Rectangle& rectangle : moved.rectangles)
    rectangle = {rotation * rectangle.corner + pose.translation, rotation * rectangle.u, rotation * rectangle.v};
  for (Cylinder& cylinder : moved.cylinders)
    cylinder = {rotation * cylinder.base + pose.translation, rotation * cylinder.axis, cylinder.radius};
  return moved;
}

void checkScene(const Scene& scene) {
  for (std::size_t i = 0; i < scene.rectangles.size(); ++i) {
    const Rectangle& r = scene.rectangles[i];
    if (!(r.corner.allFinite() && r.u.allFinite() && r.v.allFinite())) refuse("rectangle", i, "is not finite");
    if (!(r.u.norm() > 0.0 && r.v.norm() > 0.0)) refuse("rectangle", i, "has no extent");
    if (std::abs(r.u.dot(r.v)) > 1e-9 * r.u.norm() * r.v.norm()) refuse("rectangle", i, "has slanting edges");
  }
  for (std::size_t i = 0; i < scene.cylinders.size(); ++i) {
    const Cylinder& c = scene.cylinders[i];
    if (!(c.base.allFinite() && c.axis.allFinite() && std::isfinite(c.radius))) refuse("cylinder", i, "is not finite");
    if (!(c.axis.norm() > 0.0 && c.radius > 0.0)) refuse("cylinder", i, "has no extent");
  }
}

std::vector<Eigen::Vector3d> sampleSurface(const Scene& scene, double spacing) {
  require(spacing > 0.0 && std::isfinite(spacing), "spacing", spacing, "must be a positive number of metres");
  checkScene(scene);
  double area = 0.0;
  for (const Rectangle& rectangle : scene.rectangles) area += rectangle.u.norm() * rectangle.v.norm();
  for (const Cylinder& cylinder : scene.cylinders) area += 2 * kPi * cylinder.radius * cylinder.axis.norm();
  require(area < kMostSurfacePoints * spacing * spacing, "spacing", spacing,
          "must be larger: this would be more than 10^9 points");
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(area / (spacing * spacing)));
  for (const Rectangle& rectangle : scene.rectangles) append(rectangle, spacing, points);
  for (const Cylinder& cylinder : scene.cylinders) append(cylinder, spacing, points);
  return points;
}

TriangleMesh triangulate(const Scene& scene, double deviation) {
  checkScene(scene);
  require(deviation > 0.0, "deviation", deviation, "must be a positive number of metres");
  TriangleMesh mesh;
  for (const Rectangle& rectangle : scene.rectangles) append(mesh, rectangleMesh(rectangle));
  for (const Cylinder& cylinder : scene.cylinders) {
    // A chord over the angle 2 a is at most r (1 - cos a) off its arc.
    const double angle = std::acos(std::max(0.5, 1.0 - deviation / cylinder.radius));
    const double facets = std::ceil(kPi / std::max(angle, kPi / kMaxFacets));
    append(mesh, cylinderMesh(cylinder, static_cast<int>(facets)));
  }
  return mesh;
}

}  // namespace gaussmap
