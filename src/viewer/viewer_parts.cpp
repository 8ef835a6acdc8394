// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_parts.h"

#include <vtkLightCollection.h>
#include <vtkLightKit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "core/check.h"
#include "gaussmap/map/queries.h"
#include "map/map_origin.h"
#include "viewer/camera.h"
#include "viewer/legend.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kMaxSmooth = 200000;  // Gaussians that can be moved smoothly
constexpr std::size_t kMaxLinks = 25000;    // between two scales; more of them would hide the Gaussians

Vector<3> centreOf(const Glyph& glyph) {
  return {double{glyph.centre[0]}, double{glyph.centre[1]}, double{glyph.centre[2]}};
}

Box<3> boxOf(const SegmentMap& map) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box<3> box{Vector<3>::Constant(kInfinity), Vector<3>::Constant(-kInfinity)};
  for (const Segment& segment : map.segments)
    for (const Vector<2>& point : {segment.start, segment.end}) {
      box.low = box.low.cwiseMin(Vector<3>(point.x(), point.y(), 0.0));
      box.high = box.high.cwiseMax(Vector<3>(point.x(), point.y(), 0.0));
    }
  return box;
}

/// Makes a colour slightly brighter or darker, to distinguish the ellipsoids of one plane.
Colour shadeOf(Colour colour, std::size_t index) {
  constexpr double kMax = 0.14, kGoldenRatio = 0.6180339887498949;  // its multiples are spread evenly
  const double share = std::fmod(static_cast<double>(index) * kGoldenRatio, 1.0);
  for (std::uint8_t& channel : colour)
    channel = static_cast<std::uint8_t>(std::min(255.0, channel * (1.0 + kMax * (2.0 * share - 1.0))));
  return colour;
}

std::size_t countOf(const GaussianMap<3>& map, const std::optional<int>& scale) {
  return scale ? map.gaussianCount(*scale) : leaves(map).size();
}

}  // namespace

int scaleToShow(const GaussianMap<3>& map) {
  int scale = 0;
  while (scale + 1 < map.scales() && map.gaussianCount(scale) > kMaxSmooth) ++scale;
  return scale;
}

void Viewer::Parts::check() const {
  const auto* const segments = std::get_if<SegmentMap>(&scene.map);
  const auto* const surface = std::get_if<TriangleMesh>(&scene.map);
  const bool empty = surface != nullptr    ? surface->triangles.empty()
                     : segments != nullptr ? segments->segments.empty()
                                           : map()->empty();
  for (const TriangleMesh* const mesh : {surface, &scene.mesh})
    if (mesh != nullptr) checkMesh(*mesh);
  if (empty) throw std::invalid_argument(scene.name + " is empty: there is nothing to show");
  if (map() != nullptr && options.scale && (*options.scale < 0 || *options.scale >= map()->scales()))
    throw std::invalid_argument("scale " + std::to_string(*options.scale) + ": the map has the scales 0 to " +
                                std::to_string(map()->scales() - 1));
  require(options.sigma > 0.0 && options.sigma <= 1e6, "sigma", options.sigma, "must be above 0 and at most 1000000");
  require(options.view.zoom > 0.0 && options.view.zoom <= 1e6, "zoom", options.view.zoom,
          "must be above 0 and at most 1000000");
  const double span = options.view.span.value_or(1.0);
  require(span > 0.0 && span <= 1e9, "span", span, "must be above 0 and at most 1000000000");
  for (const Vector<3>& direction : {options.view.direction, options.up})
    if (!direction.allFinite() || !(direction.norm() > 1e-6))
      throw std::invalid_argument("the view direction and the up direction must be finite and not zero");
  if (options.view.middle && !options.view.middle->allFinite())
    throw std::invalid_argument("the point to look at must be finite");
}

void Viewer::Parts::build(int width, int height) {
  renderer->RemoveAllViewProps();
  ellipsoids.clear();
  if (renderer->GetLights()->GetNumberOfItems() == 0) {
    vtkNew<vtkLightKit> lights;  // a key light from above and weaker lights; all move with the eye
    lights->SetKeyLightIntensity(0.75);
    lights->SetKeyToFillRatio(2.0);
    lights->SetKeyToHeadRatio(2.2);
    lights->AddLightsToRenderer(renderer);
    renderer->SetBackground(0.88, 0.90, 0.93);
    renderer->SetBackground2(1.0, 1.0, 1.0);
    renderer->GradientBackgroundOn();
  }
  std::vector<Vector<3>> places;  // that the picture must show, relative to the origin
  if (const auto* const segments = std::get_if<SegmentMap>(&scene.map))
    places = addSegments(*segments);
  else if (const auto* const surface = std::get_if<TriangleMesh>(&scene.map))
    places = addMesh(*surface);
  else
    places = addMap(height);
  if (options.mesh && !scene.mesh.triangles.empty()) addMesh(scene.mesh);
  if (options.cloud && !scene.cloud.empty()) renderer->AddActor(pointActor(scene.cloud, origin));
  renderer->AddActor2D(textActor(title(), Corner::TopLeft, height));
  if (options.help) renderer->AddActor2D(textActor(helpText(), Corner::BottomLeft, height));
  if (!is_aimed) aim(*renderer->GetActiveCamera(), options.view, up(), places, origin, double{1.0} * width / height);
  is_aimed = true;
  renderer->ResetCameraClippingRange();
}

std::vector<Vector<3>> Viewer::Parts::addMap(int height) {
  const std::vector<int> scales = scalesOfHierarchy();
  std::vector<GaussianId> gaussians;
  if (options.hierarchy) {
    for (const int s : scales) {
      const std::vector<GaussianId> more = gaussiansOfScale(*map(), s);
      gaussians.insert(gaussians.end(), more.begin(), more.end());
    }
  } else {
    gaussians = options.scale ? gaussiansOfScale(*map(), *options.scale) : leaves(*map());
  }
  const Box<3> extent = *extentOf(*map());
  const Vector<3> size = extent.high - extent.low, upright = size.cwiseProduct(up().cwiseAbs());
  const double lift = options.hierarchy ? 0.2 * (size - upright).norm() + 0.5 * upright.norm() : 0.0;

  std::vector<Glyph> glyphs = ellipsoidGlyphs(*map(), gaussians, options.sigma, origin);
  std::vector<Vector<3>> places;
  for (std::size_t i = 0; i < glyphs.size(); ++i) {
    const Vector<3> place = centreOf(glyphs[i]) + lift * gaussians[i].scale * up();
    for (std::size_t axis = 0; axis < 3; ++axis) glyphs[i].centre[axis] = static_cast<float>(place[Eigen::Index(axis)]);
    places.push_back(place);
  }
  addEllipsoids(gaussians, glyphs, height);
  if (options.cells) addCells(options.hierarchy ? scales : std::vector<int>{scaleOfCells()}, lift);
  if (!options.hierarchy) return places;
  addLinks(scales, lift);
  std::vector<Vector<3>> corners;  // of the finest and the coarsest scale, which has few Gaussians
  for (const int s : {scales.front(), scales.back()})
    for (int corner = 0; corner < 8; ++corner)
      corners.push_back(extent.low - origin + lift * s * up() +
                        size.cwiseProduct(Vector<3>(corner & 1, corner >> 1 & 1, corner >> 2)));
  return corners;
}

void Viewer::Parts::addEllipsoids(const std::vector<GaussianId>& gaussians, const std::vector<Glyph>& glyphs,
                                  int height) {
  ColouringOptions by{options.colour, up()};
  const Colouring colouring =
      colouringOf(*map(), gaussians, by, showsErrors(by.by) ? errorsOf(gaussians) : std::vector<double>{});
  std::vector<Colour> shades = colouring.colours;
  for (std::size_t i = 0; i < shades.size(); ++i) shades[i] = shadeOf(shades[i], i);
  // Scale by scale, because a coarse scale has few large ellipsoids, which need more facets than many small ones.
  for (std::size_t first = 0, last = 0; first < glyphs.size(); first = last) {
    while (last < glyphs.size() && gaussians[last].scale == gaussians[first].scale) ++last;
    const auto part = [first = std::ptrdiff_t(first), last = std::ptrdiff_t(last)](const auto& all) {
      return std::decay_t<decltype(all)>(all.begin() + first, all.begin() + last);
    };
    const auto [fine, coarse] = facetsFor(last - first);
    ellipsoids[Detail::Round].push_back(ellipsoidActor(part(glyphs), part(shades), unitSphere(fine)));
    ellipsoids[Detail::FewTriangles].push_back(ellipsoidActor(part(glyphs), part(shades), unitSphere(coarse)));
  }
  ellipsoids[Detail::Point].push_back(centreActor(glyphs, shades));
  for (const auto& [detail, actors] : ellipsoids)
    for (const auto& actor : actors) renderer->AddActor(actor);
  setDetail(Detail::Round);
  for (const auto& actor : colourBar(colouring, height)) renderer->AddActor2D(actor);
}

void Viewer::Parts::setDetail(Detail detail) {
  for (const auto& [of, actors] : ellipsoids)
    for (const auto& actor : actors) actor->SetVisibility(of == detail);
}

void Viewer::Parts::addCells(const std::vector<int>& scales, double lift) {
  std::vector<Cube> cubes;
  for (const int s : scales)
    for (const CellKey<3>& key : map()->scale(s).keys)
      cubes.push_back({map()->grid().centre(key, s) - origin + lift * s * up(), map()->grid().side(s)});
  renderer->AddActor(cubeActor(cubes));
}

void Viewer::Parts::addLinks(const std::vector<int>& scales, double lift) {
  const auto place = [&](std::size_t index, int s) {
    return Vector<3>(gaussianAbout(origin, *map(), index, s).mean + lift * s * up());
  };
  for (const int s : scales) {
    if (s + 1 == map()->scales()) continue;
    const std::size_t count = map()->gaussianCount(s), step = (count + kMaxLinks - 1) / kMaxLinks;
    std::vector<std::pair<Vector<3>, Vector<3>>> links;
    for (std::size_t i = 0; i < count; i += step) links.emplace_back(place(i, s), place(map()->parentOf(i, s), s + 1));
    renderer->AddActor(linkActor(links));
  }
}

std::vector<Vector<3>> Viewer::Parts::addMesh(const TriangleMesh& mesh) {
  constexpr std::size_t kPlaces = 20000;
  renderer->AddActor(meshActor(mesh, origin));
  std::vector<Vector<3>> places = surfaceArea(mesh) > 0.0 ? sampleSurface(mesh, kPlaces) : mesh.vertices;
  for (Vector<3>& place : places) place -= origin;
  return places;
}

std::vector<Vector<3>> Viewer::Parts::addSegments(const SegmentMap& segments) {
  const Box<3> box = boxOf(segments);
  const double wall = std::clamp(0.04 * (box.high - box.low).norm(), 0.05, 2.5);
  for (const auto& actor : segmentActors(segments, origin, wall)) renderer->AddActor(actor);
  std::vector<Vector<3>> places;
  for (const Segment& segment : segments.segments)
    for (const Vector<2>& point : {segment.start, segment.end})
      places.emplace_back(point.x() - origin.x(), point.y() - origin.y(), 0.5 * wall);
  return places;
}

std::vector<double> Viewer::Parts::errorsOf(const std::vector<GaussianId>& gaussians) {
  std::vector<double> found;
  for (const GaussianId& id : gaussians) {
    const std::pair<ColourBy, int> key(options.colour, id.scale);
    auto known = errors.find(key);
    if (known == errors.end()) {
      std::vector<double> all = options.colour == ColourBy::Contribution ? contributions(*map(), id.scale)
                                : options.colour == ColourBy::CellError  ? errorsOfCells(*map(), id.scale)
                                                                        : gaussianErrors(*map(), id.scale, scene.cloud);
      known = errors.emplace(key, std::move(all)).first;
    }
    found.push_back(known->second[id.index]);
  }
  return found;
}

int Viewer::Parts::scaleOfCells() const {
  const int scale = options.scale.value_or(0);
  return options.colour == ColourBy::Contribution ? std::min(scale + 1, map()->scales() - 1) : scale;
}

std::vector<int> Viewer::Parts::scalesOfHierarchy() const {
  std::vector<int> scales;
  for (int s = scaleToShow(*map()); s < map()->scales(); ++s) scales.push_back(s);
  return scales;
}

std::string Viewer::Parts::title() const {
  std::ostringstream text;
  text << scene.name << "\n";
  if (map() == nullptr) {
    if (const auto* const segments = std::get_if<SegmentMap>(&scene.map))
      text << segments->segments.size() << " segments in " << segments->chains.size() << " chains";
    else
      text << std::get<TriangleMesh>(scene.map).triangles.size() << " triangles";
    return text.str();
  }
  if (options.hierarchy) {
    for (const int s : scalesOfHierarchy())
      text << (s == scalesOfHierarchy().front() ? "scales " : ", ") << s << " (" << map()->grid().side(s) << " m)";
  } else if (options.scale) {
    text << "scale " << *options.scale << " (" << map()->grid().side(*options.scale) << " m)";
  } else {
    text << "the map at its finest";
  }
  if (!options.hierarchy) text << ": " << countOf(*map(), options.scale) << " Gaussians";
  text << ", " << options.sigma << " sigma";
  return text.str();
}

}  // namespace gaussmap
