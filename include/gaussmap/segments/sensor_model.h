// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Standard deviations of what a range-bearing sensor measures, Leal 2000 eq. [1]: independent, normal, mean zero.
struct SensorNoise {
  double range = 0.02;    ///< [m], >= 0
  double bearing = 2e-3;  ///< [rad], >= 0
};

/// A possible end of a beam and how much it counts; the weights of one observation sum to 1.
struct ObservationPoint {
  Vector<2> position{0.0, 0.0};  ///< [m], map frame
  double weight = 0.0;
};

/// Where a beam may have ended: the noise of range, bearing and pose propagated through h of Leal 2000 eq. [1] without
/// linearising it.
class GAUSSMAP_API ObservationModel {
 public:
  virtual ~ObservationModel() = default;
  /// Overwrites `points` with the possible ends of one beam that returned, the same number for every beam of a scan.
  /// `number` is different for every observation of a map.
  virtual void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
                       std::vector<ObservationPoint>& points) const = 0;
};

/// M random samples each, the paper's particles (sec. 3.1). The same seed and number give the same particles.
class GAUSSMAP_API SampledObservations : public ObservationModel {
 public:
  /// Throws std::invalid_argument if samples < 1 or the noise is negative or not finite.
  explicit SampledObservations(const SensorNoise& noise = {}, int samples = 30, std::uint64_t seed = 1);
  void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
               std::vector<ObservationPoint>& points) const override;

 private:
  SensorNoise noise_;
  int samples_;
  std::uint64_t seed_;
};

/// Points with the mean and covariance of infinitely many samples, by the unscented transform of (range, bearing, x, y,
/// heading), Julier and Uhlmann 1997 with kappa = 0: ten points, four if the pose is exact.
class GAUSSMAP_API UnscentedObservations : public ObservationModel {
 public:
  /// Throws std::invalid_argument if the noise is negative or not finite.
  explicit UnscentedObservations(const SensorNoise& noise = {});
  void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
               std::vector<ObservationPoint>& points) const override;

 private:
  SensorNoise noise_;
};

}  // namespace gaussmap
