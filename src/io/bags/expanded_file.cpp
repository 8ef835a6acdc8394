// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <system_error>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/bags/compression.h"
#include "io/files/mapped_file.h"

namespace gaussmap::detail {
namespace {

struct FreeZstdStream {
  void operator()(ZSTD_DStream* stream) const { ZSTD_freeDStream(stream); }
};

/// Expands zstd frames piece by piece.
class ZstdPieces {
 public:
  explicit ZstdPieces(std::string_view packed)
      : stream_(ZSTD_createDStream()), in_{packed.data(), packed.size(), 0}, piece_(ZSTD_DStreamOutSize()) {}

  /// Returns the next piece; empty at the end, or if error() is not empty.
  std::string_view next() {
    if (!stream_) return fail("no memory");
    while (true) {
      ZSTD_outBuffer out{piece_.data(), piece_.size(), 0};
      const std::size_t before = in_.pos;
      const std::size_t missing = ZSTD_decompressStream(stream_.get(), &out, &in_);
      if (ZSTD_isError(missing) != 0) return fail(ZSTD_getErrorName(missing));
      if (out.pos > 0) {
        complete_ = missing == 0;
        return {piece_.data(), out.pos};
      }
      if (in_.pos != before) complete_ = missing == 0;
      if (in_.pos == in_.size) return complete_ ? std::string_view() : fail("it ends too early");
      if (in_.pos == before) return fail("no progress");
    }
  }
  const std::string& error() const { return error_; }

 private:
  std::string_view fail(const std::string& what) {
    error_ = what;
    return {};
  }
  std::unique_ptr<ZSTD_DStream, FreeZstdStream> stream_;
  ZSTD_inBuffer in_;
  std::vector<char> piece_;
  bool complete_ = false;
  std::string error_;
};

}  // namespace

std::string expandStart(std::string_view packed, std::size_t length) {
  std::string start;
  ZstdPieces pieces(packed);
  while (start.size() < length) {
    const std::string_view piece = pieces.next();
    if (piece.empty()) break;
    start += piece.substr(0, length - start.size());
  }
  return start;
}

ExpandedFile::ExpandedFile(const std::filesystem::path& packed) {
  const MappedFile file(packed);
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  std::string name = ((error ? std::filesystem::path("/tmp") : folder) / "gaussmap_bag_XXXXXX").string();
  const int target = mkstemp(name.data());
  const auto fail = [&](const std::string& what) {
    const int code = errno;
    if (target >= 0) close(target);
    if (target >= 0) unlink(name.c_str());
    throw FileError(packed, what + (code != 0 ? ": " + std::generic_category().message(code) : ""));
  };
  if (target < 0) fail("cannot be expanded into " + name + " (set TMPDIR to another folder)");
  constexpr std::uint64_t kAlways = std::uint64_t{256} << 20, kTimes = 200;
  const std::uint64_t limit = kAlways + kTimes * file.bytes().size();
  std::uint64_t size = 0;
  ZstdPieces pieces(file.bytes());
  for (std::string_view piece = pieces.next(); !piece.empty(); piece = pieces.next()) {
    size += piece.size();
    errno = 0;
    if (size > limit)
      fail("the zstd file of " + std::to_string(file.bytes().size()) + " bytes expands to more than " +
           std::to_string(limit) + " bytes: if it is trusted, expand it with `zstd -d`");
    while (!piece.empty()) {
      const ssize_t written = write(target, piece.data(), piece.size());
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail("cannot be expanded into " + name + " (set TMPDIR to another folder)");
      piece.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  errno = 0;
  if (!pieces.error().empty()) fail("the zstd file is damaged: " + pieces.error());
  file.requireWhole();
  close(target);
  path_ = name;
}

ExpandedFile::~ExpandedFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace gaussmap::detail
