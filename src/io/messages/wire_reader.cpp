// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/wire_reader.h"

#include <algorithm>
#include <cstdio>

namespace gaussmap::detail {
namespace {

constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kMostPadding = 7;  // bytes that can follow a message

// Representation identifiers of the RTPS and XTypes specifications. The lowest bit means little-endian.
enum Representation : unsigned { kCdr = 0, kParameterList = 2, kCdr2 = 6, kDelimited2 = 8, kParameterList2 = 10 };

}  // namespace

std::string stampText(std::chrono::nanoseconds time) {
  constexpr std::int64_t kSecond = 1000000000;
  const std::int64_t count = time.count();
  const std::int64_t seconds = count / kSecond, rest = count % kSecond;
  char text[32];
  std::snprintf(text, sizeof(text), "%s%lld.%09lld", count < 0 ? "-" : "",
                static_cast<long long>(seconds < 0 ? -seconds : seconds),
                static_cast<long long>(rest < 0 ? -rest : rest));
  return text;
}

std::string shown(std::string_view name) {
  constexpr std::size_t kLongest = 120;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const char c : name.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F)
      text += c;
    else
      text += {'\\', 'x', kDigits[byte / 16u], kDigits[byte % 16u]};
  }
  return text + (name.size() > kLongest ? "..." : "");
}

void MessageOrigin::fail(const std::string& what) const {
  throw FileError(path, shown(topic) + ", message recorded at " + stampText(log_time) + ": " + what);
}

WireReader::WireReader(std::string_view message, MessageEncoding encoding, const MessageOrigin& origin)
    : origin_(origin), bytes_(message), swapped_(isSwapped(false)) {
  if (encoding == MessageEncoding::Ros1) return;
  if (encoding != MessageEncoding::Cdr) fail("the encoding is unknown, expected CDR or ROS 1");
  if (bytes_.size() < kEncapsulation)
    fail("the message has " + std::to_string(bytes_.size()) + " bytes, expected at least the 4 of a CDR header");
  const auto byte = [this](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(bytes_[i])); };
  const unsigned representation = byte(0) << 8 | byte(1);
  if ((representation & ~1u) == kCdr2) {
    largest_alignment_ = 4;
    sized_arrays_ = true;
  } else if ((representation & ~1u) != kCdr) {
    const unsigned family = representation & ~1u;
    const bool is_known = family == kParameterList || family == kDelimited2 || family == kParameterList2;
    fail("the CDR header is of kind " + std::to_string(representation) +
         (is_known ? " (lists of parameters or types with optional parts)" : "") +
         ", expected 0, 1, 6 or 7: record the topic with ROS 2");
  }
  swapped_ = isSwapped((representation & 1u) == 0);
  aligned_ = true;
  bytes_.remove_prefix(kEncapsulation);
}

const char* WireReader::take(std::size_t bytes, std::size_t alignment, const char* what) {
  std::size_t start = position_;
  if (aligned_) {
    const std::size_t step = std::min(alignment, largest_alignment_);
    start = (start + step - 1) / step * step;
  }
  if (start > bytes_.size() || bytes > bytes_.size() - start)
    fail(std::string(what) + " needs " + std::to_string(bytes) + " bytes, but the message has only " +
         std::to_string(bytes_.size() - std::min(start, bytes_.size())) + " left of " + std::to_string(bytes_.size()));
  position_ = start + bytes;
  return bytes_.data() + start;
}

std::string_view WireReader::string(const char* what) {
  std::string_view text = bytes(what);
  // CDR counts the final NUL. Some writers leave it out of an empty string.
  if (aligned_ && !text.empty()) {
    if (text.back() != '\0') fail(std::string(what) + " does not end with a zero byte, as a string in CDR does");
    text.remove_suffix(1);
  }
  return text;
}

std::string_view WireReader::bytes(const char* what) {
  return bytes(number<std::uint32_t>(what), what);
}

FloatsView WireReader::floats(const char* what) {
  const auto length = number<std::uint32_t>(what);
  if (length == 0) return {};
  return {take(std::size_t{length} * sizeof(float), sizeof(float), what), length, swapped_};
}

FloatsView WireReader::triples(const char* what) {
  const std::size_t length = structures(what, 3 * sizeof(float));
  if (length == 0) return {};
  return {take(3 * length * sizeof(float), sizeof(float), what), 3 * length, swapped_};
}

std::size_t WireReader::structures(const char* what, std::size_t least) {
  if (sized_arrays_) number<std::uint32_t>(what);
  const std::size_t length = number<std::uint32_t>(what);
  if (length > left() / least)
    fail(std::string(what) + " has " + std::to_string(length) + " elements of at least " + std::to_string(least) +
         " bytes, but the message has only " + std::to_string(left()) + " bytes left");
  return length;
}

void WireReader::skipDoubles(std::size_t count, const char* what) {
  take(count * sizeof(double), sizeof(double), what);
}

bool WireReader::canEnd(std::size_t left) const {
  return left <= (aligned_ ? kMostPadding : 0);
}

void WireReader::requireEnd() const {
  if (!canEnd(left()))
    fail(std::to_string(left()) + " bytes follow the message: it was written with another definition of its type");
}

}  // namespace gaussmap::detail
