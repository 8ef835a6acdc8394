// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <iostream>

#include "commands/segments/segments.h"
#include "common/json.h"
#include "common/report.h"
#include "common/usage.h"
#include "drawing/observation_picture.h"

namespace gaussmap::app {
namespace {

constexpr int kDensity = 3000;  // particles that show the distribution
constexpr double kDegreesPerRadian = 57.29577951308232;

/// Returns a number of --observation. `kind`: "scan" or "beam"; `count`: how many there are.
std::size_t indexFrom(const std::string& word, const std::string& kind, std::size_t count) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size())
    throw UsageError("--observation: expected SCAN:BEAM, for example 3:90");
  if (value >= count)
    throw UsageError("--observation: no " + kind + " " + word + "; the numbers are 0 to " + std::to_string(count - 1));
  return value;
}

std::vector<Vector<2>> positionsOf(const ObservationModel& model, const LaserScan& scan, std::size_t beam) {
  std::vector<ObservationPoint> points;
  model.observe(scan, beam, 0, points);
  std::vector<Vector<2>> positions;
  for (const ObservationPoint& point : points) positions.push_back(point.position);
  return positions;
}

/// Returns (bearing, range) of points, seen from the pose of the scan. Bearings are near that of the beam.
std::vector<Vector<2>> sensedFrom(const LaserScan& scan, std::size_t beam, const std::vector<Vector<2>>& points) {
  std::vector<Vector<2>> sensed;
  const double bearing = scan.bearings[beam];
  for (const Vector<2>& point : points) {
    const Vector<2> from = point - scan.pose.translation;
    const double turn = std::atan2(from.y(), from.x()) - scan.pose.heading - bearing;
    sensed.emplace_back(bearing + std::remainder(turn, 2.0 * std::acos(-1.0)), from.norm());
  }
  return sensed;
}

/// Returns the covariance of the end of a beam from the linearised projection [m^2]: J C J^T, where J is the derivative
/// of h of Leal 2000 eq. (1) by range, bearing, x, y and heading.
Matrix<2> linearised(const LaserScan& scan, std::size_t beam, const SensorNoise& noise) {
  const double angle = scan.pose.heading + scan.bearings[beam], range = scan.ranges[beam];
  const Vector<2> along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  Eigen::Matrix<double, 2, 3> pose = Eigen::Matrix<double, 2, 3>::Identity();
  pose.col(2) = range * across;
  return noise.range * noise.range * along * along.transpose() +
         std::pow(range * noise.bearing, 2) * across * across.transpose() +
         pose * scan.pose.covariance * pose.transpose();
}

}  // namespace

void drawOneObservation(const SegmentsCommand& command, const LaserScans& input) {
  const std::string& given = command.observation;
  const std::size_t colon = given.find(':');
  const std::size_t index = indexFrom(given.substr(0, colon), "scan", input.scans.size());
  const LaserScan& scan = input.scans[index];
  const std::size_t beam =
      indexFrom(colon == std::string::npos ? "" : given.substr(colon + 1), "beam", scan.ranges.size());
  if (!scan.returned(beam)) throw UsageError("--observation " + given + ": this beam has no return; give another beam");

  const SegmentFitterOptions options = fitterOptions(command.fitter);
  const std::uint64_t seed = options.particles.seed;
  const SampledObservations particles(options.noise, options.particles.samples, seed);
  const SampledObservations many(options.noise, kDensity, seed + 1);
  LaserScan exact = scan;
  exact.pose.covariance.setZero();
  ObservationPicture picture;
  picture.measured = {scan.bearings[beam], scan.ranges[beam]};
  picture.deviation = {options.noise.bearing, options.noise.range};
  picture.sensed = sensedFrom(scan, beam, positionsOf(particles, exact, beam));
  picture.sensed_density = sensedFrom(scan, beam, positionsOf(many, exact, beam));
  picture.sensor = scan.pose.translation;
  picture.end = scan.hit(beam);
  picture.covariance = linearised(scan, beam, options.noise);
  picture.projected = positionsOf(particles, scan, beam);
  picture.projected_density = positionsOf(many, scan, beam);
  const double degrees = std::round(10.0 * kDegreesPerRadian * scan.bearings[beam]) / 10.0 + 0.0;  // no "-0.0"
  const std::string measurement = formatted("%.2f m", scan.ranges[beam]) + formatted(" at %.1f degrees", degrees);
  picture.title = input.names[index] + ", beam " + std::to_string(beam) + ": " + measurement + "; dark: the " +
                  std::to_string(options.particles.samples) +
                  " particles of the observation, pale: " + std::to_string(kDensity) + " more";
  for (const std::string& output : command.outputs) drawObservation(picture, output);
  if (command.json)
    return printJson({{"output", command.outputs},
                      {"scan", index},
                      {"beam", beam},
                      {"range", scan.ranges[beam]},
                      {"bearing", scan.bearings[beam]},
                      {"particles", options.particles.samples}});
  for (const std::string& output : command.outputs)
    std::cout << output << (&output == &command.outputs.back() ? ": " : ", ");
  std::cout << input.names[index] << ", beam " << beam << ": " << measurement << ", " << options.particles.samples
            << " particles\n";
}

}  // namespace gaussmap::app
