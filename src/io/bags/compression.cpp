// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/compression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

namespace gaussmap::detail {
namespace {

std::string wrongSize(std::size_t size) {
  return "does not expand to the " + std::to_string(size) + " bytes that are announced";
}

std::string expandZstd(std::string_view packed, char* target, std::size_t size) {
  const std::size_t done = ZSTD_decompress(target, size, packed.data(), packed.size());
  if (ZSTD_isError(done) != 0) return std::string("is damaged: ") + ZSTD_getErrorName(done);
  return done == size ? "" : wrongSize(size);
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

std::string expandLz4(std::string_view packed, char* target, std::size_t size) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return "cannot be expanded: no memory";
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(raw);
  std::size_t written = 0, missing = 1;
  char none = 0;
  // The library gets room for one more byte when the target is full, so that it can read the end mark of the frame.
  while (!packed.empty()) {
    char* const to = written < size ? target + written : &none;
    std::size_t room = size - written, taken = packed.size();
    missing = LZ4F_decompress(context.get(), to, &room, packed.data(), &taken, nullptr);
    if (LZ4F_isError(missing) != 0) return std::string("is damaged: ") + LZ4F_getErrorName(missing);
    if (room == 0 && taken == 0) return wrongSize(size);
    written += room;
    packed.remove_prefix(taken);
  }
  if (missing != 0) return "is damaged: the last lz4 frame is not complete";
  return written == size ? "" : wrongSize(size);
}

std::string expandBz2(std::string_view packed, char* target, std::size_t size) {
  constexpr std::size_t kLongest = std::numeric_limits<unsigned int>::max();
  if (packed.size() > kLongest || size > kLongest) return "is too large for bz2";
  auto written = static_cast<unsigned int>(size);
  char none = 0;
  const int code = BZ2_bzBuffToBuffDecompress(size > 0 ? target : &none, &written, const_cast<char*>(packed.data()),
                                              static_cast<unsigned int>(packed.size()), 0, 0);
  if (code == BZ_MEM_ERROR) return "cannot be expanded: no memory";
  if (code == BZ_OUTBUFF_FULL) return wrongSize(size);
  if (code != BZ_OK) return "is damaged: bz2 error " + std::to_string(code);
  return written == size ? "" : wrongSize(size);
}

}  // namespace

std::string nameOf(Compression compression) {
  switch (compression) {
    case Compression::Zstd:
      return "zstd";
    case Compression::Lz4:
      return "lz4";
    case Compression::Bz2:
      return "bz2";
    case Compression::None:
      break;
  }
  return "none";
}

std::uint64_t maxExpanded(std::uint64_t packed) {
  constexpr std::uint64_t kAlways = std::uint64_t{64} << 20, kTimes = 200;
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  return packed > (kMax - kAlways) / kTimes ? kMax : kAlways + kTimes * packed;
}

std::string expand(Compression compression, std::string_view packed, char* target, std::size_t size) {
  switch (compression) {
    case Compression::Zstd:
      return expandZstd(packed, target, size);
    case Compression::Lz4:
      return expandLz4(packed, target, size);
    case Compression::Bz2:
      return expandBz2(packed, target, size);
    case Compression::None:
      break;
  }
  if (packed.size() != size) return wrongSize(size);
  std::copy(packed.begin(), packed.end(), target);
  return "";
}

bool isZstd(std::string_view bytes) {
  return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

std::string expandMessage(std::string_view packed, std::vector<char>& message) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    return "is a zstd frame without its expanded size";
  if (size > maxExpanded(packed.size()))
    return "has " + std::to_string(packed.size()) + " bytes and claims to expand to " + std::to_string(size);
  message.resize(static_cast<std::size_t>(size));
  return expandZstd(packed, message.data(), message.size());
}

}  // namespace gaussmap::detail
