// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/compression.h"

#include <bzlib.h>
#include <lz4.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "io/bags/byte_cursor.h"

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

struct FreeZstd {
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

bool expandFirstZstd(std::string_view packed, char* target, std::size_t size) {
  constexpr int kLargestWindow = 23;  // 2^23 bytes, which only the levels above 19 exceed
  const std::unique_ptr<ZSTD_DCtx, FreeZstd> context(ZSTD_createDCtx());
  if (!context || ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kLargestWindow)) != 0)
    return false;
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  ZSTD_outBuffer out{target, size, 0};
  while (out.pos < size) {
    const std::size_t read = in.pos, written = out.pos;
    if (ZSTD_isError(ZSTD_decompressStream(context.get(), &out, &in)) != 0) return false;
    if (in.pos == read && out.pos == written) return false;
  }
  return true;
}

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

using Lz4Context = std::unique_ptr<LZ4F_dctx, FreeLz4>;

Lz4Context makeLz4Context() {
  LZ4F_dctx* raw = nullptr;
  LZ4F_createDecompressionContext(&raw, LZ4F_VERSION);  // leaves nullptr if there is no memory
  return Lz4Context(raw);
}

std::string expandLz4(std::string_view packed, char* target, std::size_t size, std::size_t room_behind) {
  const Lz4Context context = makeLz4Context();
  if (!context) return "cannot be expanded: no memory";
  std::size_t written = 0, missing = 1;
  char none = 0;
  // The library gets room for one more byte when the target is full, so that it can read the end mark of the frame.
  while (!packed.empty()) {
    char* const to = written < size ? target + written : &none;
    std::size_t room = written < size ? size + room_behind - written : 0, taken = packed.size();
    missing = LZ4F_decompress(context.get(), to, &room, packed.data(), &taken, nullptr);
    if (LZ4F_isError(missing) != 0) return std::string("is damaged: ") + LZ4F_getErrorName(missing);
    if (room == 0 && taken == 0) return wrongSize(size);
    written += room;
    packed.remove_prefix(taken);
  }
  if (missing != 0) return "is damaged: the last lz4 frame is not complete";
  return written == size ? "" : wrongSize(size);
}

/// Expands the start of the first block. The library would expand the whole block, which can have 4 MiB.
bool expandFirstLz4(std::string_view packed, char* target, std::size_t size) {
  constexpr std::uint32_t kIsRaw = std::uint32_t{1} << 31;
  const Lz4Context context = makeLz4Context();
  LZ4F_frameInfo_t info{};
  std::size_t head = packed.size();
  if (!context || LZ4F_isError(LZ4F_getFrameInfo(context.get(), &info, packed.data(), &head)) != 0) return false;
  ByteCursor cursor(packed.substr(head));
  const auto block = cursor.take<std::uint32_t>();
  const std::string_view content = cursor.takeBytes(block & ~kIsRaw);
  constexpr std::size_t kLargest = std::size_t{4} << 20;  // block by the specification
  if (!cursor.ok() || info.frameType == LZ4F_skippableFrame || content.size() > 2 * kLargest || size > kLargest)
    return false;
  if ((block & kIsRaw) != 0) {
    if (content.size() < size) return false;
    std::copy_n(content.begin(), size, target);
    return true;
  }
  const int length = static_cast<int>(size);
  return LZ4_decompress_safe_partial(content.data(), target, static_cast<int>(content.size()), length, length) ==
         length;
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

std::size_t roomBehind(Compression compression) {
  constexpr std::size_t kLargestLz4Block = std::size_t{4} << 20;
  return compression == Compression::Lz4 ? kLargestLz4Block : 0;
}

std::string expand(Compression compression, std::string_view packed, char* target, std::size_t size,
                   std::size_t room_behind) {
  switch (compression) {
    case Compression::Zstd:
      return expandZstd(packed, target, size);
    case Compression::Lz4:
      return expandLz4(packed, target, size, room_behind);
    case Compression::Bz2:
      return expandBz2(packed, target, size);
    case Compression::None:
      break;
  }
  if (packed.size() != size) return wrongSize(size);
  std::copy(packed.begin(), packed.end(), target);
  return "";
}

bool expandFirst(Compression compression, std::string_view packed, char* target, std::size_t size) {
  if (compression == Compression::Zstd) return expandFirstZstd(packed, target, size);
  return compression == Compression::Lz4 && expandFirstLz4(packed, target, size);
}

bool isZstd(std::string_view bytes) {
  return bytes.substr(0, kZstdMagicBytes) == "\x28\xB5\x2F\xFD";
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
