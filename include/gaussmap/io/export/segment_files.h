// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/segments/segment_map.h"
#include "gaussmap/version.h"

// Maps of line segments as files. All writers are atomic and write the same bytes for the same map. They throw
// FileError if the file cannot be written, and std::invalid_argument if a number is not finite or a segment is not in
// exactly one chain; the message gives the segment or the chain.
namespace gaussmap {

/// Writes a map of segments to a binary PCD file that any PCL tool can open.
///
/// The file is an organised cloud. Each row is one segment and has two points, its start and its end. The fields x y z
/// (floats, z = 0) and normal_x normal_y normal_z (towards free space) are for viewing. The other fields are for
/// loadSegmentsPcd():
/// - position[2]: x and y in doubles
/// - normal_variance, weight, last_seen: see Segment
/// - covariance[3]: variance of the offset, covariance of offset and angle, variance of the angle
/// - chain: number of the chain, from 0
/// - closed: 1 if the chain is closed, 0 if not
///
/// Throws FileError if the file cannot be written, and std::invalid_argument if the map is not valid or a coordinate
/// does not fit a float.
GAUSSMAP_API void saveSegmentsPcd(const std::filesystem::path& path, const SegmentMap& map);

/// Reads a map of segments from a file of saveSegmentsPcd(), with bit-identical values. Throws FileError if the file is
/// not a map of segments, or if a value is not finite or impossible, for example a negative variance.
GAUSSMAP_API SegmentMap loadSegmentsPcd(const std::filesystem::path& path);

/// Returns true if a PCD file has the fields normal_variance and chain, like a file of saveSegmentsPcd(). Throws
/// FileError if it is not a PCD file.
GAUSSMAP_API bool isSegmentPcd(const std::filesystem::path& path);

/// Writes a map of segments to a GeoJSON file: a FeatureCollection with one LineString per segment.
///
/// The free space is on the left of a LineString. Coordinates are metres of the map frame, not degrees. The properties
/// are chain, closed, length, normal_variance, offset_variance, offset_angle_covariance, angle_variance, weight and
/// last_seen. Throws FileError if the file cannot be written, and std::invalid_argument if the map is not valid.
GAUSSMAP_API void saveSegmentsGeoJson(const std::filesystem::path& path, const SegmentMap& map);

/// Writes a map of segments to a CSV file with one line per segment: chain, closed, start_x, start_y, end_x, end_y, and
/// the other properties of saveSegmentsGeoJson(). Throws like saveSegmentsGeoJson().
GAUSSMAP_API void saveSegmentsCsv(const std::filesystem::path& path, const SegmentMap& map);

}  // namespace gaussmap
