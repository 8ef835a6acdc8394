// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A flat piece of a scan: the points of one cell.
struct Surface {
  Eigen::Vector3d mean;    ///< [m], frame of the points
  Eigen::Vector3d normal;  ///< of unit length
  Eigen::Vector3d across;  ///< planar lasers: the normal of their plane; otherwise zero
  double thickness = 0.0;  ///< standard deviation along the normal [m]
  int level = 0;           ///< of the cell: its side is finest * 2^level
  bool covered = false;    ///< true: finer pieces represent its points
};

/// The flat pieces of a scan, in cells of several sizes. This is a small picture of a scan to compare others with.
///
/// Fine cells show details near the sensor. Coarse cells join the rings of a lidar, which are far apart at a distance.
class ScanSurfaces {
 public:
  static constexpr int kLevels = 4;

  ScanSurfaces() = default;
  /// `points`: n [m], all finite. `finest`: side of the finest cells [m]. `plane`: normal of the plane in which all
  /// points lie, as those of a planar laser; a piece is then a line.
  ScanSurfaces(const std::vector<Eigen::Vector3d>& points, double finest,
               const std::optional<Eigen::Vector3d>& plane = std::nullopt);

  const std::vector<Surface>& surfaces() const { return surfaces_; }
  double finest() const { return finest_; }
  bool planar() const { return planar_; }

  /// Returns the piece in the cell of this level that contains the point, or nullptr if there is none.
  const Surface* at(const Eigen::Vector3d& point, int level) const;

 private:
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();  // of the cell with index 0
  double finest_ = 1.0;
  bool planar_ = false;
  std::vector<Surface> surfaces_;
  struct Entry {
    std::uint64_t code;  // Morton code of the cell at its level
    std::uint32_t index;
  };
  std::array<std::vector<Entry>, kLevels> cells_;  // in ascending order of the code
};

/// Returns the centre of a cloud: the median of each coordinate [m]. `points` must not be empty.
Eigen::Vector3d medianOf(const std::vector<Eigen::Vector3d>& points);
/// Returns the median distance of the points from `centre` [m].
double medianDistance(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& centre);
/// Returns the normal of the plane in which all points lie, up to a thousandth of `extent` [m]; nullopt if there is
/// none.
std::optional<Eigen::Vector3d> planeOf(const std::vector<Eigen::Vector3d>& points, double extent);

}  // namespace gaussmap::detail
