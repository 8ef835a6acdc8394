// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "segments/line_moments.h"

namespace gaussmap::detail {

/// Sums over the beams of one scan that belong to one line. t is the position of a beam's end along the line [m].
struct BeamSums {
  double n = 0.0, t = 0.0, tt = 0.0;  ///< sums of 1, t and t^2
  double variance = 0.0;              ///< sum of the beams' variances across the line, by range and bearing noise [m^2]
};

/// The covariance of a least-squares line, propagated from the errors of the scans. All beams of a scan share its pose
/// error, so more scans reduce this error, but more beams of one scan do not.
/// Let t be the position of a beam's end along the line and d its offset from the line. Least squares solves
/// [n, sum t; sum t, sum t^2] (offset, slope) = (sum d, sum t d). This class keeps the covariance of the right-hand
/// side. t is relative to a reference point on the line.
class LineSpread {
 public:
  /// Adds the beams of a scan. The reference point must be the line's centre.
  void addScan(const BeamSums& sums, const LineFit& line, const Vector<2>& sensor, const Matrix<3>& covariance,
               std::int64_t scan);
  /// Moves the reference point along the line by `by` [m].
  void shift(double by);
  /// Reverses the direction of the line.
  void turn();
  /// Returns the spread of a part of the line that has this share of the observations and was seen by the same scans.
  LineSpread part(double share) const;
  /// Adds the observations of another line spread with the same reference point.
  void absorb(const LineSpread& other);
  double beams() const { return n_; }
  /// Returns the covariance of (offset [m], angle [rad]) of the line at its centre, which must be the reference point.
  Matrix<2> covariance(const LineFit& line) const;

 private:
  Matrix<2> pose_ = Matrix<2>::Zero();    // from the pose covariances of the scans
  Matrix<2> shared_ = Matrix<2>::Zero();  // from an offset of variance 1 per scan, shared by its beams
  double n_ = 0.0;
  double own_ = 0.0;       // sum of BeamSums::variance [m^2]
  double declared_ = 0.0;  // sum over beams of the variance from the pose covariances [m^2]

  // The contribution of the last scan. absorb() adds two contributions of the same scan before it squares them.
  std::int64_t last_scan_ = -1;
  Vector<2> last_shared_{0.0, 0.0};
  Eigen::Matrix<double, 2, 3> last_jacobian_ = Eigen::Matrix<double, 2, 3>::Zero();
  Matrix<3> last_covariance_ = Matrix<3>::Zero();
};

}  // namespace gaussmap::detail
