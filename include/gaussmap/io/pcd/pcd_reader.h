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

/// One field of a PCD file: an entry of FIELDS.
struct PcdField {
  std::string name;        ///< "_" is padding
  std::size_t size = 4;    ///< bytes per element
  char type = 'F';         ///< I, U or F
  std::size_t count = 1;   ///< elements per point
  std::size_t offset = 0;  ///< place of the first element in a record of DATA binary [bytes]
  std::size_t column = 0;  ///< place of the first element in a line of DATA ascii, from 0
};

/// The encoding of the points in a PCD file: DATA ascii, binary or binary_compressed.
enum class PcdEncoding { Ascii, Binary, BinaryCompressed };

/// The header of a PCD file.
struct GAUSSMAP_API PcdHeader {
  /// The fields in the order of the file, without those of COUNT 0. x, y and z occur once, in lower case even if the
  /// file has X, Y and Z. Other names can occur twice.
  std::vector<PcdField> fields;
  std::size_t width = 0;       ///< points per row
  std::size_t height = 1;      ///< number of rows; > 1 for an organised cloud
  std::size_t points = 0;      ///< width * height
  Pose viewpoint;              ///< the sensor's pose as written; the quaternion is not checked, see poseFault()
  bool has_viewpoint = false;  ///< false: the file has no VIEWPOINT, and `viewpoint` is the identity
  PcdEncoding encoding = PcdEncoding::Ascii;  ///< encoding of the points
  std::size_t record_size = 0;                ///< bytes per point in DATA binary
  std::size_t columns = 0;                    ///< numbers per line in DATA ascii
  std::size_t data_offset = 0;                ///< bytes before the data
  std::size_t data_line = 0;                  ///< number of the first line of data; the first line of the file is 1
  double viewpoint_step = 0.0;  ///< step of the last digit of a rounded position in VIEWPOINT [m]; 0: not rounded

  /// Returns the first field of this name, or nullptr if there is none. Padding is not found.
  const PcdField* find(const std::string& name) const;
};

/// Selects one number per point: an element of a field.
struct PcdColumn {
  std::string field;        ///< name of the field
  std::size_t element = 0;  ///< in [0, count)
};

/// Reads one PCD file (versions 0.5 to 0.7; ascii, binary, binary_compressed), which can be compressed with gzip. x, y
/// and z can be floats or doubles at any place of a record.
///
/// No file can make the reader crash, hang, or use more memory than a small multiple of the file's size; a gzip file
/// can expand to at most 16 MiB plus 100 times its size. Opening reads the header and checks it against the size of the
/// file, but reads no points. Thousands of scans can therefore be open at the same time. The file must not be truncated
/// while it is open: reading can then raise the signal SIGBUS or return zeros; see requireWhole().
class GAUSSMAP_API PcdReader {
 public:
  /// Opens a file. Throws FileError if the file is not usable; the message gives the line of the header or the byte of
  /// the file, and what to do.
  explicit PcdReader(const std::filesystem::path& path);
  ~PcdReader();
  PcdReader(PcdReader&&) noexcept;
  PcdReader& operator=(PcdReader&&) noexcept;

  /// Returns another reader of the same open file. The points that this reader keeps in memory are not copied: the new
  /// reader parses or decompresses the file again when it needs them.
  PcdReader sameFile() const;

  /// Returns the path of the file.
  const std::filesystem::path& path() const { return path_; }
  /// Returns the header of the file.
  const PcdHeader& header() const { return header_; }
  /// Returns true if the file is compressed with gzip.
  bool isGzip() const;
  /// Returns the number of points, including the invalid points of an organised cloud.
  std::size_t size() const { return header_.points; }

  /// Fills `block` with the points `first`, `first` + 1 and so on, until the block is full or the file ends.
  ///
  /// The points [m] are in the frame of the file. NaN and infinite values are kept. The block is empty if `first` is
  /// not less than size(). The first call parses an ascii file or decompresses a compressed one; the reader then keeps
  /// x, y and z in memory. Thread-safe. Throws FileError if the data are damaged.
  void read(std::size_t first, PointBlock<3>& block) const;
  /// Throws FileError if the file was truncated after it was opened. Points of earlier calls of read() can then be
  /// zeros. Call this function after the last read(). columns(), column() and records() call it themselves.
  void requireWhole() const;
  /// Gives the memory of the pages of the file that were read back to the operating system. The file can still be read.
  void releasePages() const;

  /// Returns the selected columns, size() numbers each. Integers of 8 bytes beyond 2^53 are rounded.
  ///
  /// Each call reads the file once and keeps nothing, so request all columns in one call. Thread-safe. Throws FileError
  /// if a field or an element is missing, if the type of a field is not one of PCD (see checkPcdFields()), or if the
  /// data are damaged.
  std::vector<std::vector<double>> columns(const std::vector<PcdColumn>& wanted) const;
  /// Returns one column, size() numbers. It works like columns().
  std::vector<double> column(const std::string& field, std::size_t element = 0) const;

  /// Returns all points with all their fields, size() * header().record_size bytes as in DATA binary. A program can use
  /// this to copy fields that it does not know.
  ///
  /// Integers of 8 bytes are exact, also if the file is ascii. Throws FileError if the data are damaged, or if a field
  /// of an ascii file has an unknown type.
  std::vector<char> records() const;

  /// Returns a hash by which different clouds can be distinguished. It is computed from the number of points and from
  /// blocks of bytes at about 16 places of the data. The cost does not depend on the size of the file. Copies of a file
  /// have the same hash; the same cloud in another encoding has a different one.
  std::uint64_t fingerprint() const;

 private:
  struct Body;
  PcdReader(std::filesystem::path path, PcdHeader header, std::unique_ptr<Body> body);

  std::filesystem::path path_;
  PcdHeader header_;
  std::unique_ptr<Body> body_;
};

}  // namespace gaussmap
