// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_box.h"

#include <algorithm>

#include "core/number_text.h"
#include "io/las/las_points.h"

namespace gaussmap::detail {
namespace {

std::string textOf(const Eigen::Vector3d& point) {
  return "(" + numberText(point.x()) + ", " + numberText(point.y()) + ", " + numberText(point.z()) + ")";
}

}  // namespace

std::vector<std::string> lasBoxWarnings(const LasHeader& header, const char* records, std::size_t count) {
  constexpr std::size_t kSamples = 64;
  const bool is_unset = header.minimum.isZero(0.0) && header.maximum.isZero(0.0);
  if (count == 0 || is_unset) return {};
  const std::string box = textOf(header.minimum) + " to " + textOf(header.maximum);
  if (!header.hasBox()) return {"the bounding box of the header, " + box + ", is not a box: it is ignored"};
  // Many programs round the box or compute it with floats. Only a gross difference is worth a warning.
  // Degrees need steps of 1e-7. No scanner resolves that in metres.
  const bool may_be_degrees = header.crs.text.empty() && header.scale.head<2>().cwiseAbs().maxCoeff() <= 1e-6 &&
                              header.minimum.x() >= -180.0 && header.maximum.x() <= 180.0 &&
                              header.minimum.y() >= -90.0 && header.maximum.y() <= 90.0;
  if (may_be_degrees)
    return {
        "the coordinates look like degrees of longitude and latitude, but lengths are taken as metres: convert the "
        "file with pdal translate and filters.reprojection"};
  const Eigen::Vector3d extent = header.maximum - header.minimum;
  const Eigen::Vector3d farthest = header.minimum.cwiseAbs().cwiseMax(header.maximum.cwiseAbs());
  const Eigen::Vector3d tolerance = 0.01 * extent + 1e-6 * farthest + 2.0 * header.scale.cwiseAbs();
  const std::size_t step = std::max<std::size_t>(count / kSamples, 1);
  PointBlock<3> block;
  for (std::size_t i = 0; i < count; i += step) {
    decodeLasPoints(header, records + i * header.record_length, 1, block);
    const Eigen::Vector3d point(block.coordinate[0][0], block.coordinate[1][0], block.coordinate[2][0]);
    if (((point - header.minimum).array() >= -tolerance.array()).all() &&
        ((header.maximum - point).array() >= -tolerance.array()).all())
      continue;
    return {"point " + std::to_string(i) + " at " + textOf(point) + " is outside of the bounding box of the header, " +
            box + ": check the scale and the offset"};
  }
  return {};
}

}  // namespace gaussmap::detail
