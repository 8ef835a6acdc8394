// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "gaussmap/sensor/range_image.h"

namespace gaussmap {

/// What a scan says about a point in space.
enum class Sight {
  OutOfView,     ///< no pixel there
  NoEvidence,    ///< too few of the beams around it came back
  Hidden,        ///< a beam around it ended before it
  AtSurface,     ///< close to where the beams ended
  PassedThrough  ///< all beams around it went on, and ended clearly behind it
};

/// When beams count as having gone through a point. In metres, not in cells: measured at 0.1 and 0.2 m, counted in
/// cells they fail at one of them.
struct SightOptions {
  double tolerance = 0.3;   ///< all beams around the point end at least so much farther from the sensor [m], >= 0
  double clearance = 0.35;  ///< the surface they end on keeps this distance from the point [m], >= 0: on a road seen
                            ///< at a grazing angle a beam ends metres behind a point that lies on it
};

/// Looks at a point [m, sensor frame] through an image: the 3 x 3 pixels around it (1 x 3 in an image of one row), of
/// which at least half must have returns. One pixel alone would free thin things and rims: its beam may pass beside.
Sight look(const RangeImage& image, const Eigen::Vector3d& point, const SightOptions& options = {});

}  // namespace gaussmap
