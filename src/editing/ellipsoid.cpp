// SPDX-License-Identifier: BSD-3-Clause
#include "editing/ellipsoid.h"

#include <cmath>

namespace gaussmap::detail {
namespace {

// 95 % quantile of chi^2 with D degrees of freedom; for D = 2 it is -2 ln 0.05
template <int D>
constexpr double kSquaredRadius = D == 2 ? 5.991464547107979 : 7.814727903251179;
constexpr double kMinHalfAxis = 1e-12;  // of the largest half axis; rounding can make a variance 0 or negative
constexpr int kMaxSteps = 100;          // four or five are enough

}  // namespace

template <int D>
Ellipsoid95<D>::Ellipsoid95(const Gaussian<D>& gaussian) : centre_(gaussian.mean) {
  const PrincipalAxes<D> principal = principalAxes<D>(gaussian);
  axes_ = principal.directions;
  half_axes_ = (kSquaredRadius<D> * principal.variances.cwiseMax(0.0)).cwiseSqrt();
  half_axes_ = half_axes_.cwiseMax(kMinHalfAxis * half_axes_.maxCoeff());
}

template <int D>
double Ellipsoid95<D>::distance(const Vector<D>& point) const {
  const Vector<D> y = (axes_.transpose() * (point - centre_)).cwiseAbs();
  if (!(y.cwiseQuotient(half_axes_).squaredNorm() > 1.0)) return 0.0;
  // The nearest point is h_i^2 y_i / (h_i^2 + t), where t > 0 solves sum_i (h_i y_i / (h_i^2 + t))^2 = 1. The sum
  // decreases with t and is convex, so Newton steps from below the solution stay below it. The start value is not above
  // the solution: the largest term is 1 there, or t is 0. No term exceeds 1.
  const Vector<D> squares = half_axes_.cwiseAbs2();
  double t = (half_axes_.cwiseProduct(y) - squares).maxCoeff();
  t = t > 0.0 ? t : 0.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vector<D> shifted = (squares.array() + t).matrix();
    const Vector<D> terms = half_axes_.cwiseProduct(y).cwiseQuotient(shifted).cwiseAbs2();
    const double change = (terms.sum() - 1.0) / (2.0 * terms.cwiseQuotient(shifted).sum());
    if (!(change > 1e-14 * t)) break;
    t += change;
  }
  return t * y.cwiseQuotient((squares.array() + t).matrix()).norm();
}

template class Ellipsoid95<2>;
template class Ellipsoid95<3>;

}  // namespace gaussmap::detail
