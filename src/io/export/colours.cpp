// SPDX-License-Identifier: BSD-3-Clause
#include "io/export/colours.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace gaussmap::detail {
namespace {

constexpr double kViridis[][3] = {{68, 1, 84},    {71, 45, 123}, {59, 82, 139},  {44, 114, 142}, {33, 145, 140},
                                  {40, 174, 128}, {94, 201, 98}, {173, 220, 48}, {253, 231, 37}};

constexpr double kAlong[][3] = {{70, 120, 185}, {205, 90, 70}, {222, 205, 160}};  // normal along x, y, z

}  // namespace

Colour viridis(double place) {
  const double step = (place > 0.0 ? std::min(place, 1.0) : 0.0) * (std::size(kViridis) - 1);
  const auto below = std::min(static_cast<std::size_t>(step), std::size(kViridis) - 2);
  const double part = step - static_cast<double>(below);
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] =
        static_cast<std::uint8_t>(std::lround((1.0 - part) * kViridis[below][i] + part * kViridis[below + 1][i]));
  return colour;
}

Colour normalColour(const Vector<3>& normal) {
  const Vector<3> shares = normal.cwiseAbs2() / normal.squaredNorm();
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(
        std::lround(shares.x() * kAlong[0][i] + shares.y() * kAlong[1][i] + shares.z() * kAlong[2][i]));
  return colour;
}

std::pair<double, double> colourRange(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }),
               values.end());
  if (values.empty()) return {0.0, 1.0};
  std::sort(values.begin(), values.end());
  const std::size_t last = values.size() - 1;
  const double low = values[last / 100], high = values[last - last / 100];
  return high > low ? std::make_pair(low, high) : std::make_pair(low - 0.5, low + 0.5);
}

std::pair<double, double> logColourRange(std::vector<double> values) {
  constexpr double kLargestFactor = 1e4;
  const auto hasNone = [](double value) { return !(std::isfinite(value) && value > 0.0); };
  values.erase(std::remove_if(values.begin(), values.end(), hasNone), values.end());
  if (values.empty()) return {0.1, 10.0};
  std::sort(values.begin(), values.end());
  const std::size_t last = values.size() - 1;
  const double low = values[last / 100], high = values[last - last / 100];
  if (!(high > low)) return {0.5 * low, 2.0 * high};
  return {std::max(low, high / kLargestFactor), high};
}

}  // namespace gaussmap::detail
