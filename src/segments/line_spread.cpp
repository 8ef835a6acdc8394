// SPDX-License-Identifier: BSD-3-Clause
#include "segments/line_spread.h"

namespace gaussmap::detail {
namespace {

constexpr double kFloor = 1e-12;  // keeps covariances positive definite

Matrix<2> outer(const Vector<2>& a, const Vector<2>& b) {
  return a * b.transpose();
}

}  // namespace

void LineSpread::addScan(const BeamSums& sums, const LineFit& line, const Vector<2>& sensor,
                         const Matrix<3>& covariance, std::int64_t scan) {
  last_scan_ = scan;
  last_shared_ = {sums.n, sums.t};
  shared_ += outer(last_shared_, last_shared_);
  n_ += sums.n;
  own_ += sums.variance;
  last_covariance_ = covariance;
  last_jacobian_.setZero();
  if (covariance.isZero(0.0)) return;
  // A pose error (x, y, heading) changes d by (normal, t - t_sensor) . (x, y, heading).
  const Vector<2> normal = line.normal();
  const double from = line.position(sensor);
  last_jacobian_ << sums.n * normal.x(), sums.n * normal.y(), sums.t - sums.n * from,  //
      sums.t * normal.x(), sums.t * normal.y(), sums.tt - sums.t * from;
  const Matrix<2> added = last_jacobian_ * covariance * last_jacobian_.transpose();
  pose_ += added;
  declared_ += added(0, 0) / sums.n;
}

void LineSpread::shift(double by) {
  Matrix<2> change;
  change << 1.0, 0.0, -by, 1.0;
  pose_ = change * pose_ * change.transpose();
  shared_ = change * shared_ * change.transpose();
  last_shared_ = change * last_shared_;
  last_jacobian_ = change * last_jacobian_;
}

void LineSpread::turn() {
  // t and d change their signs, but t d does not.
  for (Matrix<2>* matrix : {&pose_, &shared_}) {
    (*matrix)(0, 1) = -(*matrix)(0, 1);
    (*matrix)(1, 0) = -(*matrix)(1, 0);
  }
  last_shared_.y() = -last_shared_.y();
  last_jacobian_.row(0) = -last_jacobian_.row(0);
}

LineSpread LineSpread::part(double share) const {
  LineSpread part = *this;
  part.pose_ *= share * share;
  part.shared_ *= share * share;
  part.n_ *= share;
  part.own_ *= share;
  part.declared_ *= share;
  part.last_shared_ *= share;
  part.last_jacobian_ *= share;
  return part;
}

void LineSpread::absorb(const LineSpread& other) {
  pose_ += other.pose_;
  shared_ += other.shared_;
  n_ += other.n_;
  own_ += other.own_;
  declared_ += other.declared_;
  if (other.last_scan_ < last_scan_) return;
  if (other.last_scan_ > last_scan_) {
    last_scan_ = other.last_scan_;
    last_shared_ = other.last_shared_;
    last_jacobian_ = other.last_jacobian_;
    last_covariance_ = other.last_covariance_;
    return;
  }
  const Matrix<2> pose = last_jacobian_ * last_covariance_ * other.last_jacobian_.transpose(),
                  shared = outer(last_shared_, other.last_shared_);
  pose_ += pose + pose.transpose();
  shared_ += shared + shared.transpose();
  last_shared_ += other.last_shared_;
  last_jacobian_ += other.last_jacobian_;
}

Matrix<2> LineSpread::covariance(const LineFit& line) const {
  const double along = std::max(line.along, kFloor), own = own_ / n_;
  // The evidence contains the errors twice: in the measurements, and in the spread that the observation model adds. The
  // rest of the variance is attributed to the poses. The fit of a line to k scans leaves k - 2 degrees of freedom.
  const double left = std::max(0.0, line.across - 2.0 * (own_ + declared_) / n_);
  const double scans = n_ * n_ / std::max(shared_(0, 0), kFloor);
  Matrix<2> right = pose_ + left * scans / std::max(scans - 2.0, 1.0) * shared_;
  right(0, 0) += own * n_;
  right(1, 1) += own * n_ * along;
  // Relative to the centre of the evidence, the normal equations are diagonal.
  const Eigen::Vector2d inverse(1.0 / n_, 1.0 / (n_ * along));
  Matrix<2> result = inverse.asDiagonal() * right * inverse.asDiagonal();
  result(0, 0) += kFloor;
  result(1, 1) += kFloor;
  return result;
}

}  // namespace gaussmap::detail
