// SPDX-License-Identifier: BSD-3-Clause
#include "papers/figures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "core/in_space.h"
#include "drawing/map_picture.h"
#include "drawing/plan_view.h"
#include "drawing/segment_picture.h"
#include "gaussmap/mapping/online/online_mapper.h"

namespace gaussmap::papers {
using namespace detail;

namespace {

void addScale(const GaussianMap<2>& map, int scale, const std::string& colour, app::Panel& panel) {
  for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
    panel.ellipses.push_back(app::ellipseFromAbove(inSpace(map.gaussian(i, scale), map.grid().options().noise), 3.0));
    panel.ellipses.back().colour = colour;
  }
}

}  // namespace

void reportFigures(Report& report) {
  report.heading(2, "The figures");
  report.table(
      {"figure", "shows", "here"},
      {{"Yguel 1", "scene, fine scale, coarse scale, refined coarse scale",
        "[The figures of the paper](accuracy.md#the-figures-of-the-paper)"},
       {"Yguel 2", "shapes of tensors", "not drawn"},
       {"Yguel 3", "the parts of the system", "[Architecture](architecture.md), the path of the data"},
       {"Yguel 4", "occupancy and range image", "[Moving objects](moving-objects.md)"},
       {"Yguel 5", "contribution to eq. (6), error of cells",
        "[Where a coarse scale is wrong](accuracy.md#where-a-coarse-scale-is-wrong)"},
       {"Yguel 6", "hierarchy of clusters", "[The figures of the paper](accuracy.md#the-figures-of-the-paper)"},
       {"Yguel 7", "planar map, two scales", "below; `gaussmap draw --overlay`"},
       {"Leal 1, 2", "one observation as a Gaussian and as particles", "[Segments](segments.md)"},
       {"Leal 3", "particles of a region", "`gaussmap segments --evidence`"},
       {"Leal 4, 5", "segments of a part of 7 m x 8 m", "below"},
       {"Leal 6", "particles and segments of the whole place", "[Segments](segments.md)"},
       {"Leal 7, 8", "normal variance and counts over l_min", "below"},
       {"Leal 9", "an observer in the map", "below, as a table; `gaussmap segments --observer-path`"}});
}

void drawFigure7(const Sequence<2>& sequence, Report& report) {
  OnlineOptions options = OnlineOptions::yguel2009(2);
  options.budget = 4.0;
  OnlineMapper<2> mapper(options);
  for (const Scan& scan : sequence.scans) mapper.add(scan);
  const GaussianMap<2> map = mapper.map();
  const int coarsest = map.scales() - 1;
  app::Panel panel;
  panel.title = sequence.name + ": the coarsest scale over the finest, 3 sigma";
  panel.keys = {
      {"#1f5fd0", "coarsest scale", false}, {"#d02020", "finest scale", false}, {"#000000", "coarse cells", true}};
  addScale(map, coarsest, "#1f5fd0", panel);
  addScale(map, 0, "#d02020", panel);
  const double side = map.grid().side(coarsest);
  Box<2> window = app::emptyBox();
  for (const CellKey<2>& key : map.scale(coarsest).keys) {
    const Box<2> cell{Vector<2>(key[0], key[1]) * side, Vector<2>(key[0] + 1.0, key[1] + 1.0) * side};
    panel.squares.push_back({cell, std::nullopt});
    app::include(window, cell.low);
    app::include(window, cell.high);
  }
  // A part of the map: the whole one would be a picture of several megabytes.
  const Vector<2> middle = 0.5 * (window.low + window.high), half = Vector<2>::Constant(7.5);
  window = {middle - half, middle + half};
  const auto isOutside = [&](const Box<2>& box) {
    return (box.high.array() < window.low.array()).any() || (box.low.array() > window.high.array()).any();
  };
  panel.ellipses.erase(
      std::remove_if(panel.ellipses.begin(), panel.ellipses.end(),
                     [&](const app::Ellipse& ellipse) {
                       return isOutside({ellipse.centre - ellipse.reach(), ellipse.centre + ellipse.reach()});
                     }),
      panel.ellipses.end());
  panel.squares.erase(std::remove_if(panel.squares.begin(), panel.squares.end(),
                                     [&](const app::Square& square) { return isOutside(square.box); }),
                      panel.squares.end());
  const std::string name = "Yguel-figure-7";
  app::drawMaps({panel}, window, app::BarOptions(), report.pictureFile(name));
  report.showPicture(name, "Like Fig. 7 of Yguel 2009: a part of " + sequence.name +
                               ", on line as printed, at most 4 Gaussians per coarse cell");
}

void drawExamples(const LealResults& results, Report& report) {
  for (const benchmark::LealExampleRow& row : results.example) {
    if (row.method != benchmark::LealMethod::AsPrinted ||
        std::abs(row.sigma_threshold - results.sigma_threshold) > 1e-9)
      continue;
    app::SegmentPicture picture;
    const Box<2>& window = results.data.window;
    const auto isInside = [&](const Vector<2>& point) {
      return (point.array() >= window.low.array()).all() && (point.array() <= window.high.array()).all();
    };
    std::copy_if(row.evidence.begin(), row.evidence.end(), std::back_inserter(picture.evidence), isInside);
    SegmentMap part;
    for (const Segment& segment : row.map.segments) {
      if (!isInside(0.5 * (segment.start + segment.end))) continue;
      part.chains.push_back({part.segments.size(), part.segments.size() + 1, false});
      part.segments.push_back(segment);
    }
    if (part.segments.empty()) continue;
    std::string name = "Leal " + results.data.name + (row.dependent ? " figure 5" : " figure 4");
    std::replace(name.begin(), name.end(), ' ', '-');
    app::drawSegments(part, picture, report.pictureFile(name));
    report.showPicture(name, std::string("Like Fig. ") + (row.dependent ? "5" : "4") + " of Leal 2000, " +
                                 results.data.name + ": segments and particles, " +
                                 (row.dependent ? "eq. (5), the observer is in the middle" : "eq. (4)"));
  }
}

}  // namespace gaussmap::papers
