// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>

#include "gaussmap/sensor/range_image.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// How one scan observes a point in space.
enum class Visibility {
  OutOfView,     ///< no pixel sees the point
  NoEvidence,    ///< fewer than half of the pixels around the point have returns
  Hidden,        ///< a beam around the point ended clearly in front of it
  AtSurface,     ///< neither Hidden nor PassedThrough: the point is close to the surface that the beams hit
  PassedThrough  ///< all beams around the point ended clearly behind it
};

/// The standard deviation of a measured depth [m]: constant + growth * (depth - start)^2. Closer than `start` it is
/// `constant`. The depth is the range for a lidar and the coordinate z for a depth camera.
struct GAUSSMAP_API DepthNoise {
  double constant = 0.0;  ///< [m], >= 0
  double growth = 0.0;    ///< [1/m], >= 0
  double start = 0.0;     ///< [m], >= 0

  /// Returns the standard deviation at a depth [m].
  double at(double depth) const {
    const double beyond = std::max(0.0, depth - start);
    return constant + growth * beyond * beyond;
  }
  /// Returns the noise of a structured-light camera such as the Kinect: 0.0012 + 0.0019 (z - 0.4)^2, Nguyen, Izadi and
  /// Lovell 2012, eq. (3).
  static DepthNoise camera() { return {0.0012, 0.0019, 0.4}; }
};

/// Decides when beams pass through a point.
///
/// If a length is std::nullopt, its default depends on the side of the finest cells of the map. Each option gives two
/// values: a length in metres, used for sides of 15 mm and more, and a number of cells, used for sides of about 2 mm
/// and less. Between these sides, the default shrinks with the square of the side. visibilityOf() does not know a map
/// and uses the length in metres.
struct VisibilityOptions {
  /// The ranges of all beams around the point must exceed the range of the point by more than this [m], >= 0.
  /// std::nullopt: 0.3 m; 3 cells for cells of 2 mm and less.
  std::optional<double> tolerance = std::nullopt;
  /// The point must be at least this far from the surface on which the beams end [m], >= 0. This is needed at grazing
  /// angles: a beam can end metres behind a point, although both lie on the same road. std::nullopt: 0.35 m; 3.5 cells
  /// for cells of 2 mm and less.
  std::optional<double> clearance = std::nullopt;
  /// Noise of the sensor, which widens both limits: by three standard deviations of the depth at the point, plus three
  /// at the end of the beam. The two are added, because errors of calibration and pose are systematic. std::nullopt:
  /// none for a SphericalProjection, because both limits include the noise of a lidar; DepthNoise::camera() for a
  /// PlanarProjection.
  std::optional<DepthNoise> noise = std::nullopt;
  /// PlanarProjection only: minimum distance between the pixels around the point, at the depth of the point [m], >= 0.
  /// It allows for the errors of the poses. std::nullopt: 0.03 m; 0.3 cells for cells of 2 mm and less.
  std::optional<double> spacing = std::nullopt;
};

/// Returns the visibility of a point [m, sensor frame] from the 3 x 3 pixels around it (1 x 3 in an image of one row).
///
/// For a camera, these pixels are at least VisibilityOptions::spacing apart at the depth of the point, because poses
/// are not exact. At least half of these pixels must have returns. A single pixel is not enough at thin objects and
/// edges: its beam can pass beside them, and they would seem to be free.
GAUSSMAP_API Visibility visibilityOf(const RangeImage& image, const Eigen::Vector3d& point,
                                     const VisibilityOptions& options = {});

/// The observations of one cell or cluster by all scans. They explain why it was kept or deleted. If OnlineMapper uses
/// HitRule::RangeImage, the meaning differs: a hit is then a scan that raised the log-odds, and a miss is a scan that
/// lowered them.
struct Evidence {
  std::uint32_t hits = 0;       ///< number of scans that measured a point in the cell
  std::uint32_t misses = 0;     ///< number of scans whose beams passed through the cell
  std::uint32_t first_hit = 0;  ///< number of the first scan with a point in the cell; undefined if hits == 0
  std::uint32_t last_hit = 0;   ///< number of the last scan with a point in the cell; undefined if hits == 0

  /// Counts a hit by scan number `scan`.
  void hit(std::uint32_t scan) {
    first_hit = hits == 0 ? scan : std::min(first_hit, scan);
    last_hit = hits == 0 ? scan : std::max(last_hit, scan);
    ++hits;
  }
  /// Counts a miss.
  void miss() { ++misses; }
};

/// The changes of the occupancy log-odds by one scan. The defaults of `hit` and `miss` are those of OctoMap, the
/// log-odds of the probabilities 0.7 and 0.4.
/// With them, a static cell is kept if 32 % of the scans that see its place hit it.
struct OccupancyOptions {
  double hit = 0.85;  ///< added by a scan that measured a point in the cell, > 0
  double miss = 0.4;  ///< subtracted by a scan that passed through the cell, > 0
  /// o_max, Yguel 2009 sec. 4.4: OnlineMapper keeps log-odds within [-max_log_odds, max_log_odds], > 0.
  double max_log_odds = 10.0;
};

/// Returns the log-odds of all scans together, without bounds. The result therefore does not depend on the order of the
/// scans.
inline double logOdds(const Evidence& evidence, const OccupancyOptions& options = {}) {
  return evidence.hits * options.hit - evidence.misses * options.miss;
}

}  // namespace gaussmap
