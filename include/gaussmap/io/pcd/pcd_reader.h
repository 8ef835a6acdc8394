// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// One entry of FIELDS.
struct PcdField {
  std::string name;        ///< "_" is padding
  std::size_t size = 4;    ///< bytes an element
  char type = 'F';         ///< I, U or F
  std::size_t count = 1;   ///< elements a point
  std::size_t offset = 0;  ///< of the first element [bytes], in a record of DATA binary
  std::size_t column = 0;  ///< of the first element, in a line of DATA ascii
};

enum class PcdEncoding { Ascii, Binary, BinaryCompressed };

/// What the text part of a PCD file says.
struct GAUSSMAP_API PcdHeader {
  std::vector<PcdField> fields;  ///< in the order of the file; names differ, but for padding
  std::size_t width = 0;         ///< points a row
  std::size_t height = 1;        ///< rows: > 1 in an organised cloud
  std::size_t points = 0;        ///< width * height
  Pose viewpoint;                ///< the sensor's pose as written: the quaternion may be anything, see poseFault()
  bool has_viewpoint = false;    ///< false: viewpoint is the identity because the file says nothing
  PcdEncoding encoding = PcdEncoding::Ascii;
  std::size_t record_size = 0;  ///< bytes a point in DATA binary
  std::size_t columns = 0;      ///< numbers a line in DATA ascii
  std::size_t data_offset = 0;  ///< bytes before the data
  std::size_t data_line = 0;    ///< number of the first line of data, the file's first line is 1

  /// The field of that name, nullptr if there is none. Padding is not found.
  const PcdField* find(const std::string& name) const;
};

/// One number of every point: an element of a field.
struct PcdColumn {
  std::string field;
  std::size_t element = 0;  ///< in [0, count)
};

/// One open PCD file (versions 0.5 to 0.7; ascii, binary, binary_compressed) with x, y and z as floats or doubles
/// anywhere in it. No file makes it crash, hang, or ask for more memory than a small multiple of the file's size.
/// Opening reads the header and checks it against the size of the file, but touches no point: thousands of scans
/// may be open at once. A file that is made shorter meanwhile raises SIGBUS, see requireWhole().
class GAUSSMAP_API PcdReader {
 public:
  /// Throws FileError, with the line of the header or the byte of the file and the way out.
  explicit PcdReader(const std::filesystem::path& path);
  ~PcdReader();
  PcdReader(PcdReader&&) noexcept;
  PcdReader& operator=(PcdReader&&) noexcept;

  /// Another reader of the same open file, which parses or expands its points for itself.
  PcdReader sameFile() const;

  const std::filesystem::path& path() const { return path_; }
  const PcdHeader& header() const { return header_; }
  /// Number of points, the invalid ones of an organised cloud included.
  std::size_t size() const { return header_.points; }

  /// Fills the block with points first, first + 1 ... as far as the block or the file goes [m], in the frame of the
  /// file, NaN and infinity as they are; behind the last point the block is empty. Thread-safe. The first call
  /// parses an ascii file or expands a compressed one and keeps x, y and z for as long as the reader lives.
  /// Throws FileError if those data are damaged.
  void read(std::size_t first, PointBlock<3>& block) const;
  /// To be called after the last read(): throws FileError if the file was cut off since it was opened, because some of
  /// the points are then zeros. The calls below check this themselves.
  void requireWhole() const;

  /// The columns asked for, size() numbers each. An element I8 or U8 beyond 2^53 is rounded. Thread-safe.
  /// Throws FileError if a field or element is missing, is no scalar of 1, 2, 4 or 8 bytes, or the data are damaged.
  /// Ask for all columns in one call: each call goes once through the file and keeps nothing.
  std::vector<std::vector<double>> columns(const std::vector<PcdColumn>& wanted) const;
  std::vector<double> column(const std::string& field, std::size_t element = 0) const;

  /// All points with all their fields, size() * header().record_size bytes as in DATA binary: what a program needs that
  /// hands on fields it does not know. An 8-byte integer beyond 2^53 is rounded if the file is ascii.
  /// Throws FileError if the data are damaged, or a field of an ascii file is no number gaussmap knows.
  std::vector<char> records() const;

  /// A number that tells clouds apart: of the point count and of some bytes sampled all over the data, so that it
  /// costs the same for any size. The same for copies of a file, different for the same cloud in another encoding.
  std::uint64_t fingerprint() const;

 private:
  struct Body;
  PcdReader(std::filesystem::path path, PcdHeader header, std::unique_ptr<Body> body);

  std::filesystem::path path_;
  PcdHeader header_;
  std::unique_ptr<Body> body_;
};

}  // namespace gaussmap
