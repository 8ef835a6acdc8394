// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"
#include "io/las/las_header.h"

// The records of points, uncompressed, as in LAS files and as LAZ files give them after decompression.
namespace gaussmap::detail {

/// A value of each point, for example its intensity.
struct LasField {
  /// How the bytes are read. The bits of return numbers and classes are cut out of a byte.
  enum class Kind { UInt8, Int8, UInt16, Int16, UInt32, Int32, UInt64, Int64, Float, Double, Bits, Colour };
  std::string name;
  Kind kind = Kind::UInt8;
  std::size_t offset = 0;     ///< position in the record [bytes]
  int shift = 0;              ///< Bits: number of the lowest bit
  std::uint8_t mask = 0;      ///< Bits: mask after the shift
  double scale = 1.0;         ///< value = number * scale + shift_by
  double shift_by = 0.0;      ///< see scale
  bool has_no_data = false;   ///< a number means "no value" and becomes NaN
  std::uint64_t no_data = 0;  ///< this number: the bytes of a uint64, int64 or double
};

/// Returns the values of each point in the order of the record, then the extra bytes that the file describes.
///
/// The names are "intensity", "return_number", "number_of_returns", "classification", "withheld", "scan_angle"
/// [degrees], "user_data", "point_source_id", and by format "overlap", "scanner_channel", "time" [s], "rgb", "nir".
/// Extra bytes have their own names, or "name[0]" in arrays; a name that exists already is left out. A description of
/// the extra bytes that does not fit the record is ignored: then a text is written to `warning`.
std::vector<LasField> lasFields(const LasHeader& header, std::string& warning);

/// Decodes x, y and z of up to PointBlock<3>::kCapacity records that follow each other. Sets block.size to `count`.
void decodeLasPoints(const LasHeader& header, const char* records, std::size_t count, PointBlock<3>& block);

/// Decodes one value of records that follow each other, `record_length` bytes each. Writes `count` numbers. Colours
/// must be finished with finishLasColours() when the whole file is decoded.
void decodeLasField(const LasField& field, std::size_t record_length, const char* records, std::size_t count,
                    double* values);

/// Turns decoded colours into r << 16 | g << 8 | b. LAS stores 16 bits per channel, but some programs write only 8. So
/// all channels are divided by 256 if any channel of the file exceeds 255.
void finishLasColours(std::vector<double>& colours);

}  // namespace gaussmap::detail
