// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/colouring.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <tuple>
#include <utility>

#include "core/ellipsoid_pose.h"
#include "evaluation/error_cloud.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr Colour kGrey = {150, 150, 150};
constexpr int kBarSteps = 256;
/// Okabe and Ito 2008: colour-blind people can distinguish these colours too.
constexpr Colour kScales[] = {{86, 180, 233},  {230, 159, 0}, {0, 158, 115},
                              {204, 121, 167}, {0, 114, 178}, {213, 94, 0}};

/// Returns a paler form of errorColour(), from 0 to `red`.
Colour errorTint(double error, double red) {
  const std::uint32_t rgb = errorColour(error, red);
  const auto channel = [rgb](int shift) { return static_cast<std::uint8_t>(40 + (rgb >> shift & 0xffu) * 200 / 255); };
  return {channel(16), channel(8), channel(0)};
}

/// Returns a colouring with a continuous bar. `colour` gives the colour of a value.
template <typename ColourOf>
Colouring continuous(std::string title, const std::vector<double>& values, double low, double high,
                     const ColourOf& colour) {
  Colouring colouring;
  colouring.title = std::move(title);
  colouring.low = low;
  colouring.high = high;
  for (int i = 0; i < kBarSteps; ++i) colouring.bar.push_back(colour(low + (high - low) * (i + 0.5) / kBarSteps));
  for (const double value : values) colouring.colours.push_back(std::isfinite(value) ? colour(value) : kGrey);
  return colouring;
}

enum class Bright { Low, High };

Colouring inViridis(std::string title, const std::vector<double>& values, Bright bright) {
  const std::pair<double, double> range = colourRange(values);
  return continuous(std::move(title), values, range.first, range.second, [range, bright](double value) {
    const double place = (value - range.first) / (range.second - range.first);
    return viridis(bright == Bright::High ? place : 1.0 - place);
  });
}

/// Colours values that span orders of magnitude: large ones are dark. Zero has the colour of the lower end.
Colouring logarithmic(std::string title, const std::vector<double>& values) {
  const std::pair<double, double> range = logColourRange(values);
  Colouring colouring;
  colouring.title = std::move(title);
  std::tie(colouring.low, colouring.high) = range;
  colouring.is_logarithmic = true;
  const double width = std::log(range.second / range.first);
  for (int i = 0; i < kBarSteps; ++i) colouring.bar.push_back(viridis(1.0 - (i + 0.5) / kBarSteps));
  for (const double value : values)
    colouring.colours.push_back(!std::isfinite(value) ? kGrey
                                : value > 0.0         ? viridis(1.0 - std::log(value / range.first) / width)
                                                      : viridis(1.0));
  return colouring;
}

Colouring byScale(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians) {
  const auto colour = [](int scale) { return kScales[static_cast<std::size_t>(scale) % std::size(kScales)]; };
  Colouring colouring;
  colouring.title = "scale";
  for (int s = 0; s < map.scales(); ++s) {
    std::ostringstream name;
    name << s << " (" << map.grid().side(s) << " m)";
    colouring.bar.push_back(colour(s));
    colouring.names.push_back(name.str());
  }
  for (const GaussianId& id : gaussians) colouring.colours.push_back(colour(id.scale));
  return colouring;
}

}  // namespace

bool showsErrors(ColourBy by) {
  return by == ColourBy::Error || by == ColourBy::Contribution || by == ColourBy::CellError;
}

Colouring colouringOf(const GaussianMap<3>& map, const std::vector<GaussianId>& gaussians,
                      const ColouringOptions& options, const std::vector<double>& errors) {
  const auto gaussian = [&map](const GaussianId& id) { return map.gaussian(id.index, id.scale); };
  std::vector<double> values;
  switch (options.by) {
    case ColourBy::Scale:
      return byScale(map, gaussians);
    case ColourBy::Normal: {
      Colouring colouring;
      colouring.title = "normal";
      colouring.names = {"along x", "along y", "along z"};
      for (int axis = 0; axis < 3; ++axis) colouring.bar.push_back(normalColour(Vector<3>::Unit(axis)));
      for (const GaussianId& id : gaussians)
        colouring.colours.push_back(normalColour(ellipsoidPose(gaussian(id)).normal()));
      return colouring;
    }
    case ColourBy::Weight:
      for (const GaussianId& id : gaussians) values.push_back(std::log10(gaussian(id).weight));
      return inViridis("points [log10]", values, Bright::High);
    case ColourBy::Occupancy:
      for (const GaussianId& id : gaussians) values.push_back(double{map.logOdds(id.index, id.scale)});
      return inViridis("occupancy [log-odds]", values, Bright::High);
    case ColourBy::Error: {
      const double red = colourRange(errors).second;
      return continuous("error [m]", errors, 0.0, red, [red](double error) { return errorTint(error, red); });
    }
    case ColourBy::Contribution:
      return logarithmic("contribution\n[squared sigma]", errors);
    case ColourBy::CellError:
      return logarithmic("error of cell\n[squared sigma]", errors);
    case ColourBy::Height:
      break;
  }
  for (const GaussianId& id : gaussians) values.push_back(options.up.dot(gaussian(id).mean));
  return inViridis("height [m]", values, Bright::Low);
}

}  // namespace gaussmap
