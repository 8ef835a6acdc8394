// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "gaussmap/core/error.h"
#include "gaussmap/version.h"
#include "io/files/binary_numbers.h"
#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns a time with all its digits: "1700000000.100000000".
GAUSSMAP_API std::string stampText(std::chrono::nanoseconds time);

/// Returns the name of a topic or a frame for a message: unprintable bytes as \\xNN, shortened.
GAUSSMAP_API std::string shown(std::string_view name);

/// Where a message comes from, for errors.
struct MessageOrigin {
  std::filesystem::path path;  ///< of the recording
  std::string topic;
  std::chrono::nanoseconds log_time{0};

  /// Throws FileError with the topic and the time of the message.
  [[noreturn]] void fail(const std::string& what) const;
};

/// Returns true if numbers in this byte order differ from those of this computer.
inline bool isSwapped(bool big_endian) {
  return big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
}

/// An array of 32-bit floats inside a message.
class FloatsView {
 public:
  FloatsView() = default;
  FloatsView(const char* first, std::size_t size, bool swapped) : first_(first), size_(size), swapped_(swapped) {}
  std::size_t size() const { return size_; }
  float operator[](std::size_t i) const { return loadNumber<float>(first_ + i * sizeof(float), swapped_); }

 private:
  const char* first_ = nullptr;
  std::size_t size_ = 0;
  bool swapped_ = false;
};

/// Reads the values of a message one after another. All functions throw FileError if the message ends before the value
/// does; `what` names the value in that message.
///
/// CDR aligns a number to its size, counted from the end of the four bytes of encapsulation. XCDR version 2 aligns
/// numbers of eight bytes to four, and writes the size of an array of structures in front of it.
class WireReader {
 public:
  /// Reads the encapsulation of CDR. The bytes and the origin must outlive this object.
  WireReader(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin);

  bool isRos1() const { return !aligned_; }
  [[noreturn]] void fail(const std::string& what) const { origin_.fail(what); }

  template <typename T>
  T number(const char* what) {
    return loadNumber<T>(take(sizeof(T), sizeof(T), what), swapped_);
  }
  bool boolean(const char* what) { return number<std::uint8_t>(what) != 0; }
  /// Returns a string without its final NUL.
  std::string_view string(const char* what);
  /// Returns an array of bytes.
  std::string_view bytes(const char* what);
  /// Returns bytes whose number was read before.
  std::string_view bytes(std::size_t count, const char* what) { return {take(count, 1, what), count}; }
  /// Returns an array of floats.
  FloatsView floats(const char* what);
  /// Returns an array of structures of three floats.
  FloatsView triples(const char* what);
  /// Reads the length of an array of structures of at least `least` bytes each. Checks it against the bytes left.
  std::size_t structures(const char* what, std::size_t least);
  /// Skips numbers of eight bytes.
  void skipDoubles(std::size_t count, const char* what);
  /// Returns the number of bytes that were not read yet.
  std::size_t left() const { return bytes_.size() - position_; }
  /// Returns true if so many bytes can be the padding behind the message.
  bool canEnd(std::size_t left) const;
  /// Throws FileError if more bytes follow than padding can explain.
  void requireEnd() const;

 private:
  const char* take(std::size_t bytes, std::size_t alignment, const char* what);

  const MessageOrigin& origin_;
  std::string_view bytes_;
  std::size_t position_ = 0;
  bool aligned_ = false;
  std::size_t largest_alignment_ = 8;
  bool sized_arrays_ = false;
  bool swapped_ = false;
};

}  // namespace gaussmap::detail
