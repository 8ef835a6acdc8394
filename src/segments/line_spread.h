// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "segments/line_moments.h"

namespace gaussmap::detail {

/// Beams of one scan that belong to one line: with t the position of their ends along it.
struct BeamSums {
  double n = 0.0, t = 0.0, tt = 0.0;  ///< sum of 1, t, t^2
  double variance = 0.0;              ///< sum of the beams' own variances across the line [m^2]
};

/// What the errors of scans do to a least-squares line. All beams of a scan share its pose error: n counts scans.
/// With t the position along the line and d the offset of a beam's end, least squares solves
/// [n, sum t; sum t, sum t^2] (offset, slope) = (sum d, sum t d); kept is the covariance of the right-hand side.
class LineSpread {
 public:
  /// Adds a scan's beams; t counts from the line's centre, which is the reference.
  void addScan(const BeamSums& sums, const LineFit& line, const Vector<2>& sensor, const Matrix<3>& covariance,
               std::int64_t scan);
  /// For a reference that lies farther along the line by `by` [m].
  void shift(double by);
  /// For the line in the other direction.
  void turn();
  /// Of a part that has this share of the observations, seen by the same scans.
  LineSpread part(double share) const;
  /// Adds another one with the same reference.
  void absorb(const LineSpread& other);
  double beams() const { return n_; }
  /// Covariance of (offset, angle) of the line about its centre, which the reference must be.
  Matrix<2> covariance(const LineFit& line) const;

 private:
  Matrix<2> pose_ = Matrix<2>::Zero();    // by the covariances that the scans declare
  Matrix<2> shared_ = Matrix<2>::Zero();  // if every scan were off by an error of variance 1
  double n_ = 0.0;
  double own_ = 0.0;       // sum of the beams' own variances [m^2]
  double declared_ = 0.0;  // sum over beams of the variance by declared covariances [m^2]

  // The last scan's part: what two segments have from the same scan adds up before it is squared.
  std::int64_t last_scan_ = -1;
  Vector<2> last_shared_{0.0, 0.0};
  Eigen::Matrix<double, 2, 3> last_jacobian_ = Eigen::Matrix<double, 2, 3>::Zero();
  Matrix<3> last_covariance_ = Matrix<3>::Zero();
};

}  // namespace gaussmap::detail
