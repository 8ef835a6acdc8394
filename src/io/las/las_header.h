// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/las/las_crs.h"

// The header of LAS 1.0 to 1.4 files, which LAZ and COPC files have too.
namespace gaussmap::detail {

/// A variable length record (VLR), or an extended one (EVLR).
struct LasVlr {
  std::string_view user_id;  ///< without the zeros behind it, for example "LASF_Projection"
  std::uint16_t record_id = 0;
  std::string_view data;   ///< the bytes behind the header of the record
  std::size_t offset = 0;  ///< position of `data` in the file [bytes]
};

/// The header of a LAS or LAZ file. The views point into the bytes that were parsed, so these must stay in memory.
struct LasHeader {
  int minor_version = 0;              ///< the version is 1.minor_version, in [0, 4]
  int point_format = 0;               ///< in [0, 10], without the bits of compression
  int compression = 0;                ///< bits 6 and 7 of the byte of the format; 0: not compressed, 2: LAZ
  std::size_t record_length = 0;      ///< bytes per point, at least lasRecordLength(point_format)
  std::uint64_t points = 0;           ///< number of points, not checked against the size of the file
  std::uint16_t global_encoding = 0;  ///< bit 0: the time is adjusted standard GPS time, bit 4: the CRS is WKT
  std::size_t header_size = 0;        ///< bytes before the first VLR
  std::size_t data_offset = 0;        ///< position of the points [bytes], within the file
  std::uint64_t waveform_offset = 0;  ///< position of the waveform packets [bytes], not checked; 0: none
  std::uint64_t evlr_offset = 0;      ///< position of the first EVLR [bytes], not checked; 0: none
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();    ///< coordinate = integer * scale + offset; finite and not 0
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< finite
  Eigen::Vector3d minimum = Eigen::Vector3d::Zero();  ///< corner of the bounding box as written, not checked
  Eigen::Vector3d maximum = Eigen::Vector3d::Zero();  ///< opposite corner, not checked
  std::vector<LasVlr> vlrs;                           ///< those that lie between the header and the points
  std::vector<LasVlr> evlrs;                          ///< those that lie within the file
  LasCrs crs;                                         ///< coordinate reference system
  std::vector<std::string> warnings;                  ///< what is wrong, but does not harm the points

  /// Returns the first record with this user and number, first of the VLRs, then of the EVLRs; nullptr if there is
  /// none.
  const LasVlr* find(std::string_view user_id, std::uint16_t record_id) const;
  /// Returns true if the header has a bounding box: it is finite, not all zero, and no minimum exceeds its maximum.
  bool hasBox() const;
};

/// Returns true if a file starts like a LAS or a LAZ file.
bool hasLasSignature(std::string_view start);

/// Returns the number of bytes of a point of this format, without extra bytes. `point_format` must be in [0, 10].
std::size_t lasRecordLength(int point_format);

/// Reads the header, the VLRs and the EVLRs. `bytes` is the whole file.
///
/// Throws FileError if the header is cut off or contradicts itself. It is not checked that the points fit into the
/// file: see checkLasPoints() for uncompressed points.
LasHeader parseLasHeader(const std::filesystem::path& path, std::string_view bytes);

/// Checks that the file holds the uncompressed points that the header claims. Throws FileError with both numbers.
/// Adds a warning to the header if there is room for more points.
void checkLasPoints(const std::filesystem::path& path, std::string_view bytes, LasHeader& header);

/// Throws FileError if the coordinates are degrees and there are points. The message says how to convert the file.
void refuseLasDegrees(const std::filesystem::path& path, const LasHeader& header);

}  // namespace gaussmap::detail
