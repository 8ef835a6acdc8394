// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/segment_picture.h"

#include <algorithm>
#include <iomanip>
#include <iterator>

#include "drawing/plan_view.h"

namespace gaussmap::app {
namespace {

// Sizes in pixels.
constexpr double kMaxWidth = 1400, kMaxHeight = 1400, kSegmentMargin = 16, kSegmentLegend = 44, kSegmentFont = 11;
constexpr double kBand = 5;  // width of the band on the free side

/// Okabe and Ito 2008: colours that colour-blind people can also distinguish, on a white background.
constexpr const char* kChainColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

/// Returns the view of everything that is drawn. It is at least one metre wide and high, because a map can be a single
/// point.
PlanView viewOf(const SegmentMap& map, const SegmentPicture& picture) {
  constexpr double kMinSide = 1.0;  // [m]
  Box<2> window = emptyBox();
  for (const Segment& segment : map.segments) {
    include(window, segment.start);
    include(window, segment.end);
  }
  for (const Vector<2>& point : picture.evidence) include(window, point);
  if (!window.low.allFinite()) window = {Vector<2>::Zero(), Vector<2>::Zero()};
  const Vector<2> middle = (window.low + window.high) / 2.0;
  const Vector<2> half = ((window.high - window.low) / 2.0).cwiseMax(kMinSide / 2.0);
  const double scale = std::min(kMaxWidth / (2.0 * half.x()), kMaxHeight / (2.0 * half.y()));
  return {{middle - half, middle + half}, scale, kSegmentMargin};
}

/// Prints "x y" of a point in pixels.
struct At {
  const PlanView& view;
  const Vector<2>& point;
};
std::ostream& operator<<(std::ostream& out, const At& at) {
  return out << at.view.x(at.point.x()) << ' ' << at.view.y(at.point.y());
}

void drawPoint(Svg& svg, const PlanView& view, const Vector<2>& point) {
  svg << 'M' << At{view, point} << "h0";
}

void drawEvidence(Svg& svg, const PlanView& view, const std::vector<Vector<2>>& points) {
  svg << "<path stroke='#666' stroke-width='1.5' stroke-linecap='round' d='";
  for (const Vector<2>& point : points) drawPoint(svg, view, point);
  svg << "'/>\n";
}

void drawChain(Svg& svg, const PlanView& view, const SegmentMap& map, const SegmentMap::Chain& chain,
               const char* colour) {
  svg << "<g color='" << colour << "'>\n<path fill='currentColor' fill-opacity='.18' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i) {
    const Segment& segment = map.segments[i];
    const Vector<2> band = kBand / view.scale * segment.normal();
    const Vector<2> start = segment.start + band, end = segment.end + band;
    svg << 'M' << At{view, segment.start} << 'L' << At{view, segment.end} << 'L' << At{view, end} << 'L'
        << At{view, start} << 'z';
  }
  svg << "'/>\n<path fill='none' stroke='currentColor' stroke-width='1.4' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i)
    svg << 'M' << At{view, map.segments[i].start} << 'L' << At{view, map.segments[i].end};
  svg << "'/>\n<path stroke='currentColor' stroke-width='3.6' stroke-linecap='round' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i)
    for (const Vector<2>& point : {map.segments[i].start, map.segments[i].end}) drawPoint(svg, view, point);
  svg << "'/>\n</g>\n";
}

void drawLegend(Svg& svg, const PlanView& view, const SegmentMap& map) {
  const double y = view.height() + 2 * kSegmentMargin + 8;
  const double length =
      view.drawScaleBar(svg, kSegmentMargin, y, std::max((view.width() + 2 * kSegmentMargin) / 5, 60.0));
  svg.text(2 * kSegmentMargin + length, y + 8,
           std::to_string(map.segments.size()) + " segments in " + std::to_string(map.chains.size()) +
               " chains; pale: the free side");
}

}  // namespace

void drawSegments(const SegmentMap& map, const SegmentPicture& picture, const std::filesystem::path& path) {
  const PlanView view = viewOf(map, picture);
  Svg svg(view.width() + 2 * kSegmentMargin, view.height() + 2 * kSegmentMargin + kSegmentLegend, kSegmentFont);
  svg << std::fixed << std::setprecision(2);
  if (picture.field)
    svg << "<circle cx='" << view.x(picture.field->centre.x()) << "' cy='" << view.y(picture.field->centre.y())
        << "' r='" << picture.field->radius * view.scale << "' fill='#ffd' stroke='#aa8' stroke-dasharray='4 3'/>\n";
  if (!picture.evidence.empty()) drawEvidence(svg, view, picture.evidence);
  for (std::size_t i = 0; i < map.chains.size(); ++i)
    drawChain(svg, view, map, map.chains[i], kChainColours[i % std::size(kChainColours)]);
  drawLegend(svg, view, map);
  svg.save(path);
}

}  // namespace gaussmap::app
