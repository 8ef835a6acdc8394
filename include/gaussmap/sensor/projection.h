// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>
#include "gaussmap/version.h"

namespace gaussmap {

/// The projection of a spinning lidar that turns about the z axis of its frame. Rows are intervals of elevation,
/// columns are intervals of azimuth over the full turn. A planar laser has one row.
struct SphericalProjection {
  std::vector<double> row_borders;  ///< rows + 1 elevations above the xy plane [rad], ascending
  int columns = 0;  ///< number of columns of the full turn, >= 1; counter-clockwise from the direction -x
};

/// The projection of a depth camera, with x to the right, y down and z forward: column = fx x / z + cx,
/// row = fy y / z + cy.
struct PlanarProjection {
  /// Horizontal focal length [pixel], > 0.
  double fx = 0.0, fy = 0.0;  ///< vertical focal length [pixel], > 0
  /// Column of the principal point [pixel]. The centre of the first pixel is (0, 0).
  double cx = 0.0, cy = 0.0;  ///< row of the principal point [pixel]
  /// Number of columns of the image, >= 1.
  int columns = 0, rows = 0;  ///< number of rows of the image, >= 1
};

/// The projection of a lidar or of a depth camera.
using Projection = std::variant<SphericalProjection, PlanarProjection>;

/// A pixel of a range image.
struct Pixel {
  int row = 0;     ///< from 0
  int column = 0;  ///< from 0
};

/// Returns the number of rows of a projection.
GAUSSMAP_API int rowsOf(const Projection& projection);
/// Returns the number of columns of a projection.
GAUSSMAP_API int columnsOf(const Projection& projection);
/// Returns true if the last column is adjacent to the first one, as for a lidar.
GAUSSMAP_API bool wraps(const Projection& projection);

/// Returns the pixel that sees a point [m, sensor frame], or std::nullopt if the point is outside the field of view or
/// not a return (see isReturn()).
GAUSSMAP_API std::optional<Pixel> pixelOf(const Projection& projection, const Eigen::Vector3d& point);

/// Returns the unit vector through the centre of a pixel, sensor frame. The row must lie in the image. The column can
/// lie outside the image.
GAUSSMAP_API Eigen::Vector3d directionOf(const Projection& projection, Pixel pixel);

/// A rectangle of pixels. It includes the first and the last row and column. If the projection wraps(), columns can be
/// below 0 or beyond the last column of the image.
struct PixelBox {
  /// First row.
  int first_row = 0, last_row = -1;  ///< last row
  /// First column.
  int first_column = 0, last_column = -1;  ///< last column
  /// Returns true if the rectangle holds no pixel.
  bool empty() const { return last_row < first_row || last_column < first_column; }
};

/// Returns a rectangle that contains every pixel that can see a point of a ball. If the rectangle is empty, the whole
/// ball is out of view. The centre is in the sensor frame [m], radius >= 0 [m].
GAUSSMAP_API PixelBox pixelsOf(const Projection& projection, const Eigen::Vector3d& centre, double radius);

/// Throws std::invalid_argument if a member of a projection is out of range or the image has more than 2^28 pixels. The
/// message gives the value.
GAUSSMAP_API void checkProjection(const Projection& projection);

/// Determines the rows and columns of a spinning lidar from one of its scans [m, sensor frame], or returns std::nullopt
/// if there are fewer than three returns.
///
/// Points that are not returns (see isReturn()) are ignored. If the elevations form rings, each ring is a row.
/// Otherwise all rows have the same height: the 90 % quantile of the differences in elevation between points one above
/// the other. The height is at least the median difference in azimuth between neighbours. The width of a column is
/// twice the median difference in azimuth between neighbours of a ring. This leaves few empty pixels on a surface. If
/// no point lies more than 0.05 degrees above another, there is one row.
GAUSSMAP_API std::optional<SphericalProjection> findSphericalProjection(const std::vector<Eigen::Vector3d>& points);

/// Determines the camera of an organised cloud by least squares. Returns std::nullopt if the RMS distance between the
/// pixels of the points and their projections is one pixel or more.
///
/// The points [m, sensor frame] are row by row, with `columns` points per row. A pixel without depth is NaN.
GAUSSMAP_API std::optional<PlanarProjection> findPlanarProjection(const std::vector<Eigen::Vector3d>& points,
                                                                  int columns);

/// Returns the projection of a cloud [m, sensor frame]. For an organised cloud (`columns` > 0), the function tries
/// findPlanarProjection() first. If there is no camera, or the cloud is not organised, it uses
/// findSphericalProjection().
GAUSSMAP_API std::optional<Projection> findProjection(const std::vector<Eigen::Vector3d>& points, int columns = 0);

}  // namespace gaussmap
