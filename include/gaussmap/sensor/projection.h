// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>
#include "gaussmap/version.h"

namespace gaussmap {

/// A lidar that turns about the z axis of its frame: rows of elevation, columns of azimuth all round. Planar lasers
/// have one row.
struct SphericalProjection {
  std::vector<double> row_borders;  ///< rows + 1 elevations above the xy plane [rad], ascending
  int columns = 0;  ///< of the full turn, >= 1; column 0 begins behind the sensor (-x), counter-clockwise
};

/// A depth camera, x to the right, y down, z forward: column = fx x / z + cx, row = fy y / z + cy.
struct PlanarProjection {
  double fx = 0.0, fy = 0.0;  ///< focal lengths [pixel], > 0
  double cx = 0.0, cy = 0.0;  ///< principal point [pixel]; the centre of the first pixel is (0, 0)
  int columns = 0, rows = 0;  ///< >= 1
};

using Projection = std::variant<SphericalProjection, PlanarProjection>;

struct Pixel {
  int row = 0;
  int column = 0;
};

GAUSSMAP_API int rowsOf(const Projection& projection);
GAUSSMAP_API int columnsOf(const Projection& projection);
/// True if the last column is the first one's neighbour.
GAUSSMAP_API bool wraps(const Projection& projection);

/// The pixel that a point [m, sensor frame] is seen in; nothing outside the field of view, or for a point that is no
/// return.
GAUSSMAP_API std::optional<Pixel> pixelOf(const Projection& projection, const Eigen::Vector3d& point);

/// Unit vector through the middle of a pixel, sensor frame. The pixel's row lies in the image, its column anywhere.
GAUSSMAP_API Eigen::Vector3d directionOf(const Projection& projection, Pixel pixel);

/// Pixels that a ball may be seen in: whole rows and columns, both ends included. With `wraps`, columns may run below
/// 0 or past the last one.
struct PixelBox {
  int first_row = 0, last_row = -1;
  int first_column = 0, last_column = -1;
  bool empty() const { return last_row < first_row || last_column < first_column; }
};

/// A box of pixels that holds every pixel any point of the ball is seen in; empty if all of it is out of view.
/// centre [m, sensor frame], radius [m] >= 0.
GAUSSMAP_API PixelBox pixelsOf(const Projection& projection, const Eigen::Vector3d& centre, double radius);

/// Throws std::invalid_argument, naming the value, if a projection is not usable, or has more than 2^28 pixels.
GAUSSMAP_API void checkProjection(const Projection& projection);

/// Rows and columns of a spinning lidar from one of its scans [m, sensor frame; non-finite points and points at the
/// sensor are left out]. Rows are the rings where elevations gather in rings, else as high as the usual distance
/// between points one above the other. A column is two steps between neighbours of a ring wide, so that few pixels
/// of a surface stay empty. A scan within one plane gets one row. Nothing if there are fewer than three points.
GAUSSMAP_API std::optional<SphericalProjection> findSphericalProjection(const std::vector<Eigen::Vector3d>& points);

/// The camera that an organised cloud was seen with (row by row, `columns` points a row, NaN where there is no depth),
/// by least squares; nothing if no camera explains the points to within a pixel.
GAUSSMAP_API std::optional<PlanarProjection> findPlanarProjection(const std::vector<Eigen::Vector3d>& points,
                                                                  int columns);

/// The camera of an organised cloud (columns > 0) if there is one, else the lidar.
GAUSSMAP_API std::optional<Projection> findProjection(const std::vector<Eigen::Vector3d>& points, int columns = 0);

}  // namespace gaussmap
