// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/segments/segment_map.h"
#include "gaussmap/version.h"

// Maps of line segments as files. All writers write whole files or none (AtomicFile), the same bytes for the same map,
// and throw FileError if the file cannot be written, std::invalid_argument, naming the segment, if a number of it is
// not finite.
namespace gaussmap {

/// A binary PCD file that every PCL tool opens: an organised cloud, one segment a row, its start and its end. Fields: x
/// y z (floats, z = 0) and normal_x normal_y normal_z (towards free space) for looking at, and for reading again
/// position[2] (the same point in doubles) normal_variance covariance[3] (offset, offset and angle, angle) weight
/// last_seen, chain (number from 0) closed (of the chain); see Segment and SegmentMap.
GAUSSMAP_API void saveSegmentsPcd(const std::filesystem::path& path, const SegmentMap& map);

/// Reads what saveSegmentsPcd() wrote, to the last bit. Throws FileError if the file is no such cloud or a value is
/// impossible.
GAUSSMAP_API SegmentMap loadSegmentsPcd(const std::filesystem::path& path);

/// Has the PCD file the fields that saveSegmentsPcd() writes? Throws FileError if it is not a PCD file.
GAUSSMAP_API bool isSegmentPcd(const std::filesystem::path& path);

/// GeoJSON: a FeatureCollection with one LineString a segment, free space on its left; coordinates are metres of the
/// map frame, not degrees. Properties: chain, closed, length, normal_variance, offset_variance,
/// offset_angle_covariance, angle_variance, weight, last_seen.
GAUSSMAP_API void saveSegmentsGeoJson(const std::filesystem::path& path, const SegmentMap& map);

/// CSV, one line a segment: chain, closed, start_x, start_y, end_x, end_y and the rest of the properties above.
GAUSSMAP_API void saveSegmentsCsv(const std::filesystem::path& path, const SegmentMap& map);

}  // namespace gaussmap
