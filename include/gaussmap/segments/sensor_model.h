// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Standard deviations of a range-bearing sensor, Leal 2000 eq. (1). The errors are independent and normal, with zero
/// mean.
struct SensorNoise {
  double range = 0.02;    ///< standard deviation of the range [m], >= 0
  double bearing = 2e-3;  ///< standard deviation of the bearing [rad], >= 0
};

/// A possible end of a beam and its weight. The weights of one observation sum to 1.
struct ObservationPoint {
  Vector<2> position{0.0, 0.0};  ///< [m], frame in which the pose of the scan is given
  double weight = 0.0;           ///< share of the observation, >= 0
};

/// Computes where a beam can have ended. The function h of Leal 2000 eq. (1) gives the end of a beam from its range,
/// its bearing and the pose. A model applies h to possible ranges, bearings and poses. It does not linearise h.
class GAUSSMAP_API ObservationModel {
 public:
  virtual ~ObservationModel() = default;
  /// Replaces the content of `points` by the possible ends of one beam. The beam must have a return. `number` is the
  /// number of the observation; it is different for every observation of the map.
  ///
  /// The points must be in the frame in which the pose of the scan is given. SegmentFitter calls the model with an
  /// origin near the map, so that the coordinates are small. EvidencePolicy::ParticleSets needs M points of equal
  /// weight. If a model returns other points, SegmentFitter draws M of them by their weights; a point can be drawn
  /// several times.
  virtual void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
                       std::vector<ObservationPoint>& points) const = 0;
};

/// Represents an observation by M random samples: the particles of the paper (sec. 3.1). The same seed and number give
/// the same particles.
class GAUSSMAP_API SampledObservations : public ObservationModel {
 public:
  /// Makes a model with M = `samples`. Throws std::invalid_argument if samples < 1, or if the noise is negative or not
  /// finite.
  explicit SampledObservations(const SensorNoise& noise = {}, int samples = 30, std::uint64_t seed = 1);
  void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
               std::vector<ObservationPoint>& points) const override;

 private:
  SensorNoise noise_;
  int samples_;
  std::uint64_t seed_;
};

/// Represents an observation by a few points. Their mean and covariance are close to those of infinitely many samples.
///
/// The points come from the unscented transform of (range, bearing, x, y, heading), Julier and Uhlmann 1997 with
/// kappa = 0. There are ten points, or four if the pose is exact.
class GAUSSMAP_API UnscentedObservations : public ObservationModel {
 public:
  /// Makes a model of the given noise. Throws std::invalid_argument if the noise is negative or not finite.
  explicit UnscentedObservations(const SensorNoise& noise = {});
  void observe(const LaserScan& scan, std::size_t beam, std::uint64_t number,
               std::vector<ObservationPoint>& points) const override;

 private:
  SensorNoise noise_;
};

}  // namespace gaussmap
