// SPDX-License-Identifier: BSD-3-Clause
#include "segment_picture.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <limits>

#include "gaussmap/map/grid.h"
#include "svg.h"

namespace gaussmap::app {
using namespace detail;

namespace {

// All in pixels.
constexpr double kMostWidth = 1400, kMostHeight = 1400, kSegmentMargin = 16, kSegmentLegend = 44, kSegmentFont = 11;
constexpr double kBand = 5;  // on the free side

/// Okabe and Ito 2008: told apart by everybody, and on white paper.
constexpr const char* kChainColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

/// Where everything is.
struct SegmentLayout {
  Box<2> window;  // [m]
  double scale;   // pixels a metre

  double x(const Vector<2>& point) const { return kSegmentMargin + (point.x() - window.low.x()) * scale; }
  double y(const Vector<2>& point) const { return kSegmentMargin + (window.high.y() - point.y()) * scale; }
  double width() const { return (window.high.x() - window.low.x()) * scale + 2 * kSegmentMargin; }
  double height() const { return (window.high.y() - window.low.y()) * scale + 2 * kSegmentMargin + kSegmentLegend; }
};

SegmentLayout layOut(const SegmentMap& map, const SegmentPicture& picture) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box<2> window{Vector<2>::Constant(kInfinity), Vector<2>::Constant(-kInfinity)};
  const auto add = [&window](const Vector<2>& point) {
    window.low = window.low.cwiseMin(point);
    window.high = window.high.cwiseMax(point);
  };
  for (const Segment& segment : map.segments) {
    add(segment.start);
    add(segment.end);
  }
  for (const Vector<2>& point : picture.evidence) add(point);
  if (!window.low.allFinite()) window = {Vector<2>::Zero(), Vector<2>::Zero()};
  const double least = 1.0;  // [m]; a map may be a single point
  const Vector<2> middle = (window.low + window.high) / 2.0;
  const Vector<2> half = ((window.high - window.low) / 2.0).cwiseMax(least / 2.0);
  window = {middle - half, middle + half};
  return {window, std::min(kMostWidth / (2.0 * half.x()), kMostHeight / (2.0 * half.y()))};
}

void drawEvidence(Svg& svg, const SegmentLayout& layout, const std::vector<Vector<2>>& points) {
  svg << "<path stroke='#666' stroke-width='1.5' stroke-linecap='round' d='";
  for (const Vector<2>& point : points) svg << 'M' << layout.x(point) << ' ' << layout.y(point) << "h0";
  svg << "'/>\n";
}

void drawChain(Svg& svg, const SegmentLayout& layout, const SegmentMap& map, const SegmentMap::Chain& chain,
               const char* colour) {
  svg << "<g color='" << colour << "'>\n<path fill='currentColor' fill-opacity='.18' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i) {
    const Segment& segment = map.segments[i];
    const Vector<2> band = kBand / layout.scale * segment.normal();
    const Vector<2> start = segment.start + band, end = segment.end + band;
    svg << 'M' << layout.x(segment.start) << ' ' << layout.y(segment.start) << 'L' << layout.x(segment.end) << ' '
        << layout.y(segment.end) << 'L' << layout.x(end) << ' ' << layout.y(end) << 'L' << layout.x(start) << ' '
        << layout.y(start) << 'z';
  }
  svg << "'/>\n<path fill='none' stroke='currentColor' stroke-width='1.4' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i)
    svg << 'M' << layout.x(map.segments[i].start) << ' ' << layout.y(map.segments[i].start) << 'L'
        << layout.x(map.segments[i].end) << ' ' << layout.y(map.segments[i].end);
  svg << "'/>\n<path stroke='currentColor' stroke-width='3.6' stroke-linecap='round' d='";
  for (std::size_t i = chain.first; i < chain.last; ++i)
    for (const Vector<2>& point : {map.segments[i].start, map.segments[i].end})
      svg << 'M' << layout.x(point) << ' ' << layout.y(point) << "h0";
  svg << "'/>\n</g>\n";
}

void drawLegend(Svg& svg, const SegmentLayout& layout, const SegmentMap& map) {
  const double y = layout.height() - kSegmentLegend + 8;
  const double metres = roundLength(std::max(layout.width() / 5, 60.0) / layout.scale), length = metres * layout.scale;
  svg << "<path d='M" << kSegmentMargin << ' ' << y << "v6h" << length << "v-6' fill='none' stroke='black'/>\n";
  svg.text(kSegmentMargin + length / 2, y + 22, numberText(metres) + " m", "text-anchor='middle'");
  svg.text(2 * kSegmentMargin + length, y + 8,
           std::to_string(map.segments.size()) + " segments in " + std::to_string(map.chains.size()) +
               " chains; pale: the free side");
}

}  // namespace

void drawSegments(const SegmentMap& map, const SegmentPicture& picture, const std::filesystem::path& path) {
  const SegmentLayout layout = layOut(map, picture);
  Svg svg(layout.width(), layout.height(), kSegmentFont);
  svg << std::fixed << std::setprecision(2);
  if (picture.field)
    svg << "<circle cx='" << layout.x(picture.field->centre) << "' cy='" << layout.y(picture.field->centre) << "' r='"
        << picture.field->radius * layout.scale << "' fill='#ffd' stroke='#aa8' stroke-dasharray='4 3'/>\n";
  if (!picture.evidence.empty()) drawEvidence(svg, layout, picture.evidence);
  for (std::size_t i = 0; i < map.chains.size(); ++i)
    drawChain(svg, layout, map, map.chains[i], kChainColours[i % std::size(kChainColours)]);
  drawLegend(svg, layout, map);
  svg.save(path);
}

}  // namespace gaussmap::app
