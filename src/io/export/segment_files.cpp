// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/export/segment_checks.h"
#include "io/files/mapped_file.h"
#include "io/pcd/pcd_header.h"
#include "io/pcd/pcd_points.h"

namespace gaussmap {
using namespace detail;

namespace {

/// One point of the file: one end of a segment.
struct Record {
  std::array<float, 3> xyz, normal;
  std::array<double, 2> position;
  double normal_variance;
  std::array<double, 3> covariance;
  double weight;
  std::int64_t last_seen;
  std::uint32_t chain;
  std::uint8_t closed;
};

/// Returns every field of a record. It is used for writing and for reading.
std::vector<PcdOutput> fieldsOf(const Record& r) {
  constexpr std::size_t kStride = sizeof(Record);
  return {pcdOutput("x", &r.xyz[0], 1, kStride),
          pcdOutput("y", &r.xyz[1], 1, kStride),
          pcdOutput("z", &r.xyz[2], 1, kStride),
          pcdOutput("normal_x", &r.normal[0], 1, kStride),
          pcdOutput("normal_y", &r.normal[1], 1, kStride),
          pcdOutput("normal_z", &r.normal[2], 1, kStride),
          pcdOutput("position", r.position.data(), 2, kStride),
          pcdOutput("normal_variance", &r.normal_variance, 1, kStride),
          pcdOutput("covariance", r.covariance.data(), 3, kStride),
          pcdOutput("weight", &r.weight, 1, kStride),
          pcdOutput("last_seen", &r.last_seen, 1, kStride),
          pcdOutput("chain", &r.chain, 1, kStride),
          pcdOutput("closed", &r.closed, 1, kStride)};
}

Record toRecord(const Segment& segment, const Vector<2>& point, std::size_t chain, bool closed) {
  const Vector<2> normal = segment.normal();
  Record record{};
  record.xyz = {static_cast<float>(point.x()), static_cast<float>(point.y()), 0.0F};
  record.normal = {static_cast<float>(normal.x()), static_cast<float>(normal.y()), 0.0F};
  record.position = {point.x(), point.y()};
  record.normal_variance = segment.normal_variance;
  record.covariance = {segment.covariance(0, 0), segment.covariance(0, 1), segment.covariance(1, 1)};
  record.weight = segment.weight;
  record.last_seen = segment.last_seen;
  record.chain = static_cast<std::uint32_t>(chain);
  record.closed = closed ? 1 : 0;
  return record;
}

Segment toSegment(const Record& start, const Record& end) {
  Segment segment;
  segment.start = {start.position[0], start.position[1]};
  segment.end = {end.position[0], end.position[1]};
  segment.normal_variance = start.normal_variance;
  segment.covariance << start.covariance[0], start.covariance[1], start.covariance[1], start.covariance[2];
  segment.weight = start.weight;
  segment.last_seen = start.last_seen;
  return segment;
}

bool isPossible(const Segment& segment) {
  return isFinite(segment) && segment.normal_variance >= 0.0 && segment.weight >= 0.0 &&
         segment.covariance(0, 0) >= 0.0 && segment.covariance(1, 1) >= 0.0 && segment.last_seen >= 0;
}

std::vector<Record> readRecords(const std::filesystem::path& path) {
  const PcdReader reader(path);
  Record record{};
  std::vector<Record> records;
  records.reserve(reader.size());
  readPoints(reader, fieldsOf(record), "map of segments", [&](std::size_t) { records.push_back(record); });
  if (records.size() % 2 != 0) throw FileError(path, "is not a map of segments: the number of end points is odd");
  return records;
}

}  // namespace

void saveSegmentsPcd(const std::filesystem::path& path, const SegmentMap& map) {
  checkSegments(map);
  std::vector<Record> records;
  records.reserve(2 * map.segments.size());
  for (std::size_t c = 0; c < map.chains.size(); ++c) {
    for (std::size_t i = map.chains[c].first; i < map.chains[c].last; ++i) {
      const Segment& segment = map.segments[i];
      for (const Vector<2>& point : {segment.start, segment.end}) {
        if (point.cwiseAbs().maxCoeff() > double{std::numeric_limits<float>::max()})
          throw std::invalid_argument("segment " + std::to_string(i) + " is too far away for the floats of a PCD file");
        records.push_back(toRecord(segment, point, c, map.chains[c].closed));
      }
    }
  }
  const Record none{};
  writePcd(path, records.size(), fieldsOf(records.empty() ? none : records.front()), std::nullopt, 2);
}

bool isSegmentPcd(const std::filesystem::path& path) {
  if (!isPcd(MappedFile(path).bytes().substr(0, 4096))) return false;
  const PcdReader reader(path);
  return reader.header().find("normal_variance") != nullptr && reader.header().find("chain") != nullptr;
}

SegmentMap loadSegmentsPcd(const std::filesystem::path& path) {
  const std::vector<Record> records = readRecords(path);
  SegmentMap map;
  for (std::size_t i = 0; i < records.size() / 2; ++i) {
    const Record& record = records[2 * i];
    map.segments.push_back(toSegment(record, records[2 * i + 1]));
    if (!isPossible(map.segments.back()))
      throw FileError(path, "row " + std::to_string(i) + " is not a segment: a value is impossible or not finite");
    if (map.chains.empty() || record.chain != map.chains.size() - 1) {
      if (record.chain != map.chains.size())
        throw FileError(path, "row " + std::to_string(i) + " belongs to chain " + std::to_string(record.chain) +
                                  ", but the next chain is number " + std::to_string(map.chains.size()));
      map.chains.push_back({i, i, record.closed != 0});
    }
    map.chains.back().last = i + 1;
  }
  return map;
}

}  // namespace gaussmap
