// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/observation_picture.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iomanip>

#include "drawing/plan_view.h"
#include "drawing/svg.h"

namespace gaussmap::app {
namespace {

// Sizes in pixels.
constexpr double kFrameSide = 340, kFrameLeft = 64, kFrameTop = 58, kFrameBottom = 62, kFrameGap = 84, kFrameFont = 12;
constexpr const char* kGaussianColour = "#0072b2";
constexpr const char* kParticleColour = "#d55e00";
constexpr double kDegreesPerBearing = 57.29577951308232;

/// A square of the picture and what it shows.
struct ObservationFrame {
  double left = 0.0;  // [pixels]
  Vector<2> low{0.0, 0.0}, high{1.0, 1.0};

  double x(double value) const { return left + (value - low.x()) / (high.x() - low.x()) * kFrameSide; }
  double y(double value) const { return kFrameTop + (high.y() - value) / (high.y() - low.y()) * kFrameSide; }
  bool contains(const Vector<2>& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};

void drawObservationFrame(Svg& svg, const ObservationFrame& frame, const std::string& title) {
  svg << "<rect x='" << frame.left << "' y='" << kFrameTop << "' width='" << kFrameSide << "' height='" << kFrameSide
      << "' fill='none' stroke='#444'/>\n";
  svg.text(frame.left, kFrameTop - 9, title, "font-weight='bold'");
}

/// Draws ticks at about five round values along an axis, and its name.
void drawObservationAxis(Svg& svg, const ObservationFrame& frame, int axis, double unit, const std::string& name) {
  const double low = unit * frame.low[axis], high = unit * frame.high[axis], step = roundLength((high - low) / 3.0);
  const double bottom = kFrameTop + kFrameSide;
  for (double value = std::ceil(low / step) * step; value <= high + 1e-9 * step; value += step) {
    const double shown = std::abs(value) < 1e-9 * step ? 0.0 : value;
    if (axis == 0) {
      const double x = frame.x(value / unit);
      svg << "<path stroke='#444' d='M" << x << ' ' << bottom << "v5'/>\n";
      svg.text(x, bottom + 19, numberText(shown), "text-anchor='middle'");
    } else {
      const double y = frame.y(value / unit);
      svg << "<path stroke='#444' d='M" << frame.left << ' ' << y << "h-5'/>\n";
      svg.text(frame.left - 8, y + 4, numberText(shown), "text-anchor='end'");
    }
  }
  if (axis == 0) return svg.text(frame.left + kFrameSide / 2, bottom + 38, name, "text-anchor='middle'");
  svg << "<g transform='translate(" << frame.left - 50 << ' ' << kFrameTop + kFrameSide / 2 << ") rotate(-90)'>\n";
  svg.text(0, 0, name, "text-anchor='middle'");
  svg << "</g>\n";
}

/// Draws points, as far as they are in the frame.
void drawSamples(Svg& svg, const ObservationFrame& frame, const std::vector<Vector<2>>& points,
                 const std::string& style) {
  svg << "<path stroke-linecap='round' " << style << " d='";
  for (const Vector<2>& point : points)
    if (frame.contains(point)) svg << 'M' << frame.x(point.x()) << ' ' << frame.y(point.y()) << "h0";
  svg << "'/>\n";
}

void drawSampledCloud(Svg& svg, const ObservationFrame& frame, const std::vector<Vector<2>>& density,
                      const std::vector<Vector<2>>& particles) {
  drawSamples(svg, frame, density,
              std::string("stroke-width='2' stroke-opacity='.3' stroke='") + kParticleColour + "'");
  drawSamples(svg, frame, particles, "stroke-width='5' stroke='#7a2f00'");
}

/// Draws the ellipses at 1, 2 and 3 standard deviations.
void drawGaussian(Svg& svg, const ObservationFrame& frame, const Vector<2>& mean, const Matrix<2>& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Vector<2> half = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  for (const int deviations : {3, 2, 1}) {
    svg << "<path stroke='" << kGaussianColour << "' fill='" << kGaussianColour << "' fill-opacity='.13' d='";
    constexpr int kCorners = 96;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2.0 * std::acos(-1.0) * i / kCorners;
      const Vector<2> point = mean + deviations * (half.x() * std::cos(angle) * solver.eigenvectors().col(0) +
                                                   half.y() * std::sin(angle) * solver.eigenvectors().col(1));
      svg << (i == 0 ? 'M' : 'L') << frame.x(point.x()) << ' ' << frame.y(point.y());
    }
    svg << "z'/>\n";
  }
}

ObservationFrame sensorFrame(const ObservationPicture& observation, double left) {
  constexpr double kReach = 3.8;  // standard deviations
  const Vector<2> reach = kReach * observation.deviation.cwiseMax(Vector<2>(1e-4, 1e-3));
  return {left, observation.measured - reach, observation.measured + reach};
}

/// Returns a frame with equal scales around the particles and the ellipses.
ObservationFrame planeFrame(const ObservationPicture& observation, double left) {
  Box<2> box = emptyBox();
  for (const Vector<2>& point : observation.projected_density) include(box, point);
  for (const Vector<2>& point : observation.projected) include(box, point);
  const Vector<2> reach = 3.2 * observation.covariance.diagonal().cwiseSqrt();
  include(box, observation.end - reach);
  include(box, observation.end + reach);
  const Vector<2> middle = 0.5 * (box.low + box.high);
  const double half = 0.52 * std::max((box.high - box.low).maxCoeff(), 1e-3);
  return {left, middle - Vector<2>(half, half), middle + Vector<2>(half, half)};
}

/// Draws an arrow that points to the sensor, at the end of the beam.
void drawToSensor(Svg& svg, const ObservationFrame& frame, const ObservationPicture& observation) {
  const Vector<2> to = observation.sensor - observation.end;
  if (to.norm() == 0.0) return;
  const Vector<2> way = to.normalized(), side(-way.y(), way.x());
  const double x = frame.left + 48 - 20 * way.x(), y = kFrameTop + kFrameSide - 48 + 20 * way.y();
  const auto at = [&](double along, double across) -> Svg& {
    return svg << x + along * way.x() + across * side.x() << ' ' << y - along * way.y() - across * side.y();
  };
  svg << "<path fill='none' stroke='black' d='M";
  at(0, 0) << 'L';
  at(40, 0) << 'M';
  at(32, 5) << 'L';
  at(40, 0) << 'L';
  at(32, -5) << "'/>\n";
  svg.text(frame.left + 48, kFrameTop + kFrameSide - 10, "to the sensor", "text-anchor='middle'");
}

}  // namespace

void drawObservation(const ObservationPicture& observation, const std::filesystem::path& path) {
  const double step = kFrameSide + kFrameGap;
  Svg svg(kFrameLeft + 3 * kFrameSide + 2 * kFrameGap + 20, kFrameTop + kFrameSide + kFrameBottom, kFrameFont);
  svg << std::fixed << std::setprecision(2);
  svg.text(kFrameLeft, 22, observation.title);
  const ObservationFrame first = sensorFrame(observation, kFrameLeft),
                         second = sensorFrame(observation, kFrameLeft + step),
                         third = planeFrame(observation, kFrameLeft + 2 * step);
  Matrix<2> noise = Matrix<2>::Zero();
  noise.diagonal() = observation.deviation.cwiseAbs2();
  drawObservationFrame(svg, first, "Gaussian (1, 2, 3 sigma), sensor space");
  drawGaussian(svg, first, observation.measured, noise);
  drawObservationFrame(svg, second, "particles, sensor space");
  drawSampledCloud(svg, second, observation.sensed_density, observation.sensed);
  for (const ObservationFrame& frame : {first, second}) {
    drawObservationAxis(svg, frame, 0, kDegreesPerBearing, "bearing [degrees]");
    drawObservationAxis(svg, frame, 1, 1.0, "range [m]");
  }
  drawObservationFrame(svg, third, "plane: particles, linearised Gaussian");
  drawGaussian(svg, third, observation.end, observation.covariance);
  drawSampledCloud(svg, third, observation.projected_density, observation.projected);
  drawObservationAxis(svg, third, 0, 1.0, "x [m]");
  drawObservationAxis(svg, third, 1, 1.0, "y [m]");
  drawToSensor(svg, third, observation);
  svg.save(path);
}

}  // namespace gaussmap::app
