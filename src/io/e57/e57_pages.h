// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/files/mapped_file.h"

namespace gaussmap::detail {

/// The header at the start of an E57 file, without the signature.
struct E57Header {
  std::uint32_t major_version = 0, minor_version = 0;
  std::uint64_t file_bytes = 0;  ///< physical length of the file
  std::uint64_t xml_offset = 0;  ///< physical offset of the XML section
  std::uint64_t xml_bytes = 0;   ///< logical length of the XML section
  std::uint64_t page_bytes = 0;  ///< length of a page with its checksum
};

/// Reads the pages of an E57 file and verifies their checksums.
///
/// The last 4 bytes of each page are the CRC-32C of the other bytes. Physical offsets count these checksums, logical
/// offsets do not. All functions are thread-safe.
class E57Pages {
 public:
  /// Maps a file and reads its header. Throws FileError if the header is damaged or contradicts the size of the file.
  explicit E57Pages(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  const E57Header& header() const { return header_; }
  /// Number of bytes of the file, without the checksums.
  std::uint64_t logicalBytes() const { return header_.file_bytes / header_.page_bytes * pageData(); }
  /// Number of bytes after the last page. They belong to no page.
  std::uint64_t trailingBytes() const { return file_.bytes().size() - header_.file_bytes; }

  /// Returns the logical offset of a physical one. Throws FileError, which begins with `what`, if there are fewer than
  /// `bytes` logical bytes from there to the end of the file, or if the offset lies in a checksum.
  std::uint64_t logicalOffset(std::uint64_t physical, std::uint64_t bytes, const std::string& what) const;
  /// Returns the physical offset of a logical one, for messages.
  std::uint64_t physicalOffset(std::uint64_t logical) const {
    return logical / pageData() * header_.page_bytes + logical % pageData();
  }
  /// Copies logical bytes. Throws FileError if the checksum of a page is wrong, or if there are not so many bytes.
  void copy(std::uint64_t logical, std::size_t bytes, char* to) const;

  /// Throws FileError if the file was truncated while it was read.
  void requireWhole() const { file_.requireWhole(); }
  /// Gives the memory of the pages of the file that were read back to the operating system.
  void release() const { file_.release(); }

 private:
  std::uint64_t pageData() const { return header_.page_bytes - sizeof(std::uint32_t); }
  void readHeader();
  void verify(std::size_t page) const;

  std::filesystem::path path_;
  MappedFile file_;
  E57Header header_;
  std::unique_ptr<std::atomic<bool>[]> verified_;  // one per page
};

}  // namespace gaussmap::detail
