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
  const double most_wide = picture.beside ? kMaxWidth / 2.0 : kMaxWidth;
  if (picture.window) {
    const Vector<2> size = picture.window->high - picture.window->low;
    return {*picture.window, std::min(most_wide / size.x(), kMaxHeight / size.y()), kSegmentMargin};
  }
  Box<2> window = emptyBox();
  for (const Segment& segment : map.segments) {
    include(window, segment.start);
    include(window, segment.end);
  }
  for (const Vector<2>& point : picture.evidence) include(window, point);
  for (const Vector<2>& point : picture.path) include(window, point);
  if (!window.low.allFinite()) window = {Vector<2>::Zero(), Vector<2>::Zero()};
  const Vector<2> middle = (window.low + window.high) / 2.0;
  const Vector<2> half = ((window.high - window.low) / 2.0).cwiseMax(kMinSide / 2.0);
  const double scale = std::min(most_wide / (2.0 * half.x()), kMaxHeight / (2.0 * half.y()));
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

void drawEvidence(Svg& svg, const PlanView& view, bool has_window, const std::vector<Vector<2>>& points) {
  svg << "<path stroke='#666' stroke-width='1.5' stroke-linecap='round' d='";
  for (const Vector<2>& point : points)
    if (!has_window || isInBox<2>(view.window, point)) drawPoint(svg, view, point);
  svg << "'/>\n";
}

/// Draws the way of an observer, and a dot where it is now.
void drawPath(Svg& svg, const PlanView& view, const std::vector<Vector<2>>& path) {
  svg << "<path fill='none' stroke='#a60' stroke-dasharray='5 3' d='";
  for (std::size_t i = 0; i < path.size(); ++i) svg << (i == 0 ? 'M' : 'L') << At{view, path[i]};
  svg << "'/>\n<path stroke='#a60' stroke-width='9' stroke-linecap='round' d='";
  drawPoint(svg, view, path.back());
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

void drawField(Svg& svg, const PlanView& view, const SegmentPicture::Field& field) {
  svg << "<circle cx='" << view.x(field.centre.x()) << "' cy='" << view.y(field.centre.y()) << "' r='"
      << field.radius * view.scale << "' fill='#ffd' stroke='#aa8' stroke-dasharray='4 3'/>\n";
}

/// Draws what `draw` draws, moved to the right by `right` [pixels]. With a window, cuts it off at the window's sides.
template <typename Draw>
void drawPart(Svg& svg, const PlanView& view, bool has_window, double right, const Draw& draw) {
  if (right > 0.0) svg << "<g transform='translate(" << right << " 0)'>\n";
  if (has_window) svg << "<g clip-path='url(#window)'>\n";
  draw();
  if (has_window)
    svg << "</g>\n<rect x='" << view.margin << "' y='" << view.margin << "' width='" << view.width() << "' height='"
        << view.height() << "' fill='none' stroke='#999'/>\n";
  if (right > 0.0) svg << "</g>\n";
}

/// Returns how many segments meet the window of the view, which may be cut at its sides.
std::size_t countIn(const PlanView& view, const SegmentMap& map) {
  const auto isInside = [&](const Segment& segment) {
    double from = 0.0, to = 1.0;  // the part of the segment in the window (Liang and Barsky 1984)
    for (int axis = 0; axis < 2; ++axis) {
      const double start = segment.start[axis], along = segment.end[axis] - start;
      const double low = view.window.low[axis] - start, high = view.window.high[axis] - start;
      if (along == 0.0) {
        if (low > 0.0 || high < 0.0) return false;
        continue;
      }
      from = std::max(from, std::min(low / along, high / along));
      to = std::min(to, std::max(low / along, high / along));
    }
    return from <= to;
  };
  return static_cast<std::size_t>(std::count_if(map.segments.begin(), map.segments.end(), isInside));
}

void drawLegend(Svg& svg, const PlanView& view, const SegmentMap& map, bool has_window) {
  const double y = view.height() + 2 * kSegmentMargin + 8;
  const double length =
      view.drawScaleBar(svg, kSegmentMargin, y, std::max((view.width() + 2 * kSegmentMargin) / 5, 60.0));
  const std::string count = has_window ? std::to_string(countIn(view, map)) + " of " : "";
  svg.text(2 * kSegmentMargin + length, y + 8,
           count + std::to_string(map.segments.size()) + " segments in " + std::to_string(map.chains.size()) +
               " chains; pale: the free side");
}

}  // namespace

void drawSegments(const SegmentMap& map, const SegmentPicture& picture, const std::filesystem::path& path) {
  const PlanView view = viewOf(map, picture);
  const bool has_window = picture.window.has_value();
  const double right = picture.beside ? view.width() + kSegmentMargin : 0.0;
  Svg svg(right + view.width() + 2 * kSegmentMargin, view.height() + 2 * kSegmentMargin + kSegmentLegend, kSegmentFont);
  svg << std::fixed << std::setprecision(2);
  if (has_window)
    svg << "<clipPath id='window'><rect x='" << view.margin << "' y='" << view.margin << "' width='" << view.width()
        << "' height='" << view.height() << "'/></clipPath>\n";
  if (picture.beside)
    drawPart(svg, view, has_window, 0.0, [&] { drawEvidence(svg, view, has_window, picture.evidence); });
  drawPart(svg, view, has_window, right, [&] {
    if (picture.field) drawField(svg, view, *picture.field);
    if (!picture.evidence.empty() && !picture.beside) drawEvidence(svg, view, has_window, picture.evidence);
    for (std::size_t i = 0; i < map.chains.size(); ++i)
      drawChain(svg, view, map, map.chains[i], kChainColours[i % std::size(kChainColours)]);
    if (!picture.path.empty()) drawPath(svg, view, picture.path);
  });
  drawLegend(svg, view, map, has_window);
  svg.save(path);
}

}  // namespace gaussmap::app
