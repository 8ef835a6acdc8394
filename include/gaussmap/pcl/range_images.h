// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/range_image/range_image.h>

#include "gaussmap/core/pose.h"
#include "gaussmap/sensor/range_image.h"

namespace gaussmap {

/// The nearest ranges as PCL's range image (pixels of equal angles, LASER_FRAME: x forward, y left, z up), with the
/// sensor at `sensor` in the map frame. Of an image without any return: an empty one. Throws std::invalid_argument for
/// a camera's image: PCL has another class for those.
pcl::RangeImage toPclRangeImage(const RangeImage& image, const Pose& sensor);

/// The other way round: rows and columns are those of PCL's image; its far ranges (+infinity) and what it has not
/// observed become pixels without a return. `sensor` is the pose that PCL's image was made with.
/// Throws std::invalid_argument if the image has no angular resolution (it is empty).
RangeImage fromPclRangeImage(const pcl::RangeImage& image, const Pose& sensor);

}  // namespace gaussmap
