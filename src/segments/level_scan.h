// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>

#include "gaussmap/core/scans.h"
#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Maximum difference of the heights of the points of a planar laser [m], because its poses may tilt a little.
inline constexpr double kMaxPlanarHeight = 0.5;

/// Returns the message for a scan that is not that of a planar laser, because the heights of its points range from
/// `lowest` to `highest` [m, map frame].
std::string notPlanarText(double lowest, double highest);

/// Returns a scan projected to the plane z = 0 of the map frame. The pose keeps its x, y and heading, and loses z and
/// the tilt. The points keep their x and y in the map frame, and their order. NaN points stay NaN.
///
/// Uses only the heights of `options`: with `slice`, points outside it become NaN. Throws std::invalid_argument if
/// there is no `slice` and the heights of the points differ by more than kMaxPlanarHeight.
GAUSSMAP_API Scan levelled(const Scan& scan, const PlanarScanOptions& options = {});

/// Returns the pose of a sweep as a pose in space, with z = 0.
GAUSSMAP_API Pose poseOf(const LaserScan& beams);
/// Returns the end of a beam in the sensor frame, with z = 0 [m]; NaN if it has no return.
GAUSSMAP_API Eigen::Vector3d pointOf(const LaserScan& beams, std::size_t beam);
/// Returns a sweep as a scan with one point per beam, see pointOf().
GAUSSMAP_API Scan scanOfBeams(const LaserScan& beams);

/// Returns scans unchanged, but checks that each is that of a planar laser. ScanReader::requireWhole() throws FileError
/// if the heights of the points that were read differ by more than kMaxPlanarHeight.
class GAUSSMAP_API PlanarLaserScans : public Scans {
 public:
  /// `scans` must live as long as this object.
  explicit PlanarLaserScans(const Scans& scans) : scans_(scans) {}

  std::size_t size() const override { return scans_.size(); }
  ScanInfo info(std::size_t index) const override { return scans_.info(index); }
  ScanFrame frame() const override { return scans_.frame(); }
  std::unique_ptr<ScanReader> open(std::size_t index) const override;

 private:
  const Scans& scans_;
};

}  // namespace gaussmap::detail
