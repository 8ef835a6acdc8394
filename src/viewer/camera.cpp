// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gaussmap {
namespace {

constexpr double kHalfAngle = 15.0;  // half of the vertical field of view [degree]
constexpr double kMargin = 1.06;
constexpr double kNearest = 1.0;  // [m]
constexpr int kSteps = 4;
constexpr std::size_t kOutermost = 200;  // one in this many points may lie outside at either end of an axis

struct Span {
  double low, high;
  double middle() const { return 0.5 * (low + high); }
};

/// Returns the range of the points along an axis, without the outermost.
Span spanAlong(const Vector<3>& axis, const std::vector<Vector<3>>& points) {
  std::vector<double> places;
  places.reserve(points.size());
  for (const Vector<3>& point : points) places.push_back(axis.dot(point));
  std::sort(places.begin(), places.end());
  const std::size_t last = places.size() - 1, cut = last / kOutermost;
  return {places[cut], places[last - cut]};
}

/// Returns the up direction of the picture: `up`, or y if the view is along `up`, or -z if `up` is y as well.
Vector<3> upInPicture(const Vector<3>& up, const Vector<3>& back) {
  for (const Vector<3>& candidate : {up, Vector<3>(0, 1, 0)})
    if (candidate.cross(back).norm() > 1e-3 * candidate.norm()) return candidate;
  return {0, 0, -1};
}

/// Returns the distance of the eye from the middle at which all but the outermost points are visible [m].
double distanceFor(const Vector<3>& middle, const Vector<3>& right, const Vector<3>& up, const Vector<3>& back,
                   const std::vector<Vector<3>>& points, double tangent, double aspect, bool perspective) {
  std::vector<double> needed;
  needed.reserve(points.size());
  for (const Vector<3>& point : points) {
    const Vector<3> p = point - middle;
    const double aside = kMargin * std::max(std::abs(right.dot(p)) / aspect, std::abs(up.dot(p))) / tangent;
    needed.push_back(aside + (perspective ? back.dot(p) : 0.0));
  }
  std::sort(needed.begin(), needed.end());
  return std::max(needed[needed.size() - 1 - (needed.size() - 1) / kOutermost], kNearest);
}

}  // namespace

void aim(vtkCamera& camera, const ViewPoint& view, const Vector<3>& upwards, const std::vector<Vector<3>>& points,
         const Vector<3>& origin, double aspect) {
  const Vector<3> back = view.direction.normalized();
  const Vector<3> right = Vector<3>(upInPicture(upwards, back).cross(back)).normalized(), up = back.cross(right);
  const double tangent = std::tan(kHalfAngle * std::acos(-1.0) / 180.0);
  Vector<3> middle = spanAlong(right, points).middle() * right + spanAlong(up, points).middle() * up +
                     spanAlong(back, points).middle() * back;
  if (view.middle) middle = *view.middle - origin;
  double distance = distanceFor(middle, right, up, back, points, tangent, aspect, view.perspective);
  // With perspective, near objects look larger, so the middle of the picture is not the middle of the scene.
  for (int step = 0; step < kSteps && view.perspective && !view.middle; ++step) {
    std::vector<Vector<3>> seen;  // on the plane through the middle
    for (const Vector<3>& point : points) {
      const Vector<3> from_middle = point - middle;
      seen.emplace_back(from_middle * distance / std::max(distance - back.dot(from_middle), 0.1 * distance));
    }
    middle += spanAlong(right, seen).middle() * right + spanAlong(up, seen).middle() * up;
    distance = distanceFor(middle, right, up, back, points, tangent, aspect, view.perspective);
  }
  distance = view.span ? 0.5 * *view.span / tangent : distance / view.zoom;
  const Vector<3> eye = middle + distance * back;
  camera.SetParallelProjection(!view.perspective);
  camera.SetParallelScale(distance * tangent);
  camera.SetViewAngle(2.0 * kHalfAngle);
  camera.SetFocalPoint(middle.data());
  camera.SetPosition(eye.data());
  camera.SetViewUp(up.data());
}

}  // namespace gaussmap
