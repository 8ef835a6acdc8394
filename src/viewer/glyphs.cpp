// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/glyphs.h"

#include "core/ellipsoid_pose.h"
#include "gaussmap/map/queries.h"
#include "map/map_origin.h"

namespace gaussmap {
using namespace detail;

std::vector<Glyph> ellipsoidGlyphs(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians, double sigma,
                                   const Vector<3>& origin) {
  std::vector<Glyph> glyphs;
  glyphs.reserve(gaussians.size());
  for (const GaussianId& id : gaussians) {
    const Gaussian<3> gaussian = gaussianAbout(origin, map, id.index, id.scale);
    const EllipsoidPose pose = ellipsoidPose(gaussian);
    const Eigen::Vector3f centre = gaussian.mean.cast<float>(), half = (sigma * pose.deviations).cast<float>();
    glyphs.push_back({{centre.x(), centre.y(), centre.z()},
                      {static_cast<float>(pose.rotation.w()), static_cast<float>(pose.rotation.x()),
                       static_cast<float>(pose.rotation.y()), static_cast<float>(pose.rotation.z())},
                      {half.x(), half.y(), half.z()}});
  }
  return glyphs;
}

Vector<3> middleOf(const GaussianMap<3>& map) {
  const std::optional<Box<3>> extent = extentOf(map);
  if (!extent) return Vector<3>::Zero();
  return 0.5 * (extent->low + extent->high);
}

}  // namespace gaussmap
