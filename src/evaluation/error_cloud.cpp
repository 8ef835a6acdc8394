// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/error_cloud.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::detail {
namespace {

constexpr double kExactFloats = 16384.0;  // [m]; up to this distance from the origin, a float resolves 1 mm
constexpr double kOriginStep = 1024.0;    // [m]

/// Returns the origin of the written coordinates: zero for a cloud near the origin.
Pose originOf(const std::vector<Vector<3>>& points) {
  Pose origin;
  Vector<3> low = points.front(), high = low;
  for (const Vector<3>& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  if (low.cwiseAbs().maxCoeff() > kExactFloats || high.cwiseAbs().maxCoeff() > kExactFloats)
    origin.translation = kOriginStep * (0.5 / kOriginStep * (low + high)).array().round().matrix();
  return origin;
}

}  // namespace

std::uint32_t errorColour(double error, double red) {
  const double share = red > 0.0 ? std::clamp(error / red, 0.0, 1.0) : 0.0;
  const auto channel = [share](double peak) {  // full up to 1/4 from its peak, zero from 1/2 on
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(2.0 - 4.0 * std::abs(share - peak), 0.0, 1.0)));
  };
  return channel(1.0) << 16 | channel(0.5) << 8 | channel(0.0);
}

void writeErrorCloud(const std::filesystem::path& path, const std::vector<Vector<3>>& points,
                     const std::vector<double>& errors) {
  if (points.empty()) throw std::invalid_argument("no points: an error cloud needs at least one");
  if (errors.size() != points.size())
    throw std::invalid_argument(std::to_string(errors.size()) + " errors for " + std::to_string(points.size()) +
                                " points");
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (!std::isfinite(errors[i])) throw std::invalid_argument("error " + std::to_string(i) + " is not finite");

  const double red = summarise(errors).q99;
  const Pose origin = originOf(points);
  struct Record {
    float position[3], error;
    std::uint32_t colour;
  };
  std::vector<Record> records;
  records.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector<3> local = points[i] - origin.translation;
    records.push_back({{static_cast<float>(local.x()), static_cast<float>(local.y()), static_cast<float>(local.z())},
                       static_cast<float>(errors[i]),
                       errorColour(errors[i], red)});
  }
  const Record& first = records.front();
  writePcd(
      path, records.size(),
      {pcdOutput("x", &first.position[0], 1, sizeof(Record)), pcdOutput("y", &first.position[1], 1, sizeof(Record)),
       pcdOutput("z", &first.position[2], 1, sizeof(Record)), pcdOutput("error", &first.error, 1, sizeof(Record)),
       PcdOutput{"rgb", 'F', 4, 1, &first.colour, sizeof(Record)}},
      origin);
}

}  // namespace gaussmap::detail
