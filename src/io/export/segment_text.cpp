// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <string>

#include "gaussmap/io/export/segment_files.h"
#include "io/export/segment_checks.h"
#include "io/files/atomic_file.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Returns the shortest text that reads back as the same number.
template <typename Number>
std::string text(Number value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string jsonPoint(const Vector<2>& point) {
  return "[" + text(point.x()) + "," + text(point.y()) + "]";
}

std::string jsonFeature(const Segment& segment, std::size_t chain, bool closed) {
  return "{\"type\":\"Feature\",\"geometry\":{\"type\":\"LineString\",\"coordinates\":[" + jsonPoint(segment.start) +
         "," + jsonPoint(segment.end) + "]},\"properties\":{\"chain\":" + text(chain) +
         ",\"closed\":" + (closed ? "true" : "false") + ",\"length\":" + text(segment.length()) +
         ",\"normal_variance\":" + text(segment.normal_variance) +
         ",\"offset_variance\":" + text(segment.covariance(0, 0)) +
         ",\"offset_angle_covariance\":" + text(segment.covariance(0, 1)) +
         ",\"angle_variance\":" + text(segment.covariance(1, 1)) + ",\"weight\":" + text(segment.weight) +
         ",\"last_seen\":" + text(segment.last_seen) + "}}";
}

std::string csvLine(const Segment& segment, std::size_t chain, bool closed) {
  std::string line = text(chain) + (closed ? ",1" : ",0");
  for (const double value : {segment.start.x(), segment.start.y(), segment.end.x(), segment.end.y(), segment.length(),
                             segment.normal_variance, segment.covariance(0, 0), segment.covariance(0, 1),
                             segment.covariance(1, 1), segment.weight})
    line += "," + text(value);
  return line + "," + text(segment.last_seen) + "\n";
}

/// Calls use(segment, number of its chain, whether the chain is closed) for every segment.
template <typename Use>
void forEachSegment(const SegmentMap& map, const Use& use) {
  for (std::size_t c = 0; c < map.chains.size(); ++c)
    for (std::size_t i = map.chains[c].first; i < map.chains[c].last; ++i)
      use(map.segments[i], c, map.chains[c].closed);
}

void write(const std::filesystem::path& path, const std::string& content) {
  AtomicFile file(path);
  file.write(content.data(), content.size());
  file.commit();
}

}  // namespace

void saveSegmentsGeoJson(const std::filesystem::path& path, const SegmentMap& map) {
  checkSegments(map);
  std::string features;
  forEachSegment(map, [&](const Segment& segment, std::size_t chain, bool closed) {
    features += (features.empty() ? "\n" : ",\n") + jsonFeature(segment, chain, closed);
  });
  write(path, "{\"type\":\"FeatureCollection\",\"features\":[" + features + "\n]}\n");
}

void saveSegmentsCsv(const std::filesystem::path& path, const SegmentMap& map) {
  checkSegments(map);
  std::string lines =
      "chain,closed,start_x,start_y,end_x,end_y,length,normal_variance,offset_variance,offset_angle_covariance,"
      "angle_variance,weight,last_seen\n";
  forEachSegment(
      map, [&](const Segment& segment, std::size_t chain, bool closed) { lines += csvLine(segment, chain, closed); });
  write(path, lines);
}

}  // namespace gaussmap
