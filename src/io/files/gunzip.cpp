// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/gunzip.h"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {
namespace {

constexpr std::string_view kMagic = "\x1F\x8B";
constexpr int kGzip = 15 + 16;  // zlib: the largest window, a gzip header
constexpr std::size_t kAtOnce = std::size_t{1} << 20;

/// Expands gzip data from a place in memory.
class Inflater {
 public:
  Inflater(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes), rest_(bytes) {
    if (inflateInit2(&stream_, kGzip) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Appends at most `most` bytes to `text`. Returns false at the end of the data.
  bool appendTo(std::string& text, std::size_t most) {
    const std::size_t before = text.size();
    text.resize(before + most);
    stream_.next_out = reinterpret_cast<Bytef*>(text.data() + before);
    stream_.avail_out = static_cast<uInt>(most);
    while (stream_.avail_out > 0 && !ended_) expand();
    text.resize(before + most - stream_.avail_out);
    return !ended_;
  }

 private:
  void expand() {
    const std::size_t given = std::min(rest_.size(), kAtOnce);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));  // zlib does not write there
    stream_.avail_in = static_cast<uInt>(given);
    const uInt room = stream_.avail_out;
    const int state = inflate(&stream_, Z_NO_FLUSH);
    rest_.remove_prefix(given - stream_.avail_in);
    const bool is_stuck = given == stream_.avail_in && room == stream_.avail_out;
    if (state == Z_STREAM_END) {
      ended_ = !isGzip(rest_);  // several gzip files may be joined
      if (!ended_) inflateReset(&stream_);
      if (ended_ && rest_.find_first_not_of('\0') != std::string_view::npos)
        throw FileError(path_, std::to_string(rest_.size()) + " bytes follow the gzip data");
    } else if (state == Z_BUF_ERROR || (state == Z_OK && is_stuck)) {
      throw FileError(path_, "the gzip data end too early: the file is cut off");
    } else if (state != Z_OK) {
      throw FileError(path_, "byte " + std::to_string(bytes_.size() - rest_.size()) + ": the gzip data are damaged");
    }
  }

  const std::filesystem::path& path_;
  std::string_view bytes_, rest_;
  z_stream stream_{};
  bool ended_ = false;
};

}  // namespace

bool isGzip(std::string_view bytes) {
  return bytes.substr(0, kMagic.size()) == kMagic;
}

std::size_t maxGunzipped(std::size_t bytes) {
  return (std::size_t{16} << 20) + 100 * bytes;
}

std::string gunzip(const std::filesystem::path& path, std::string_view bytes) {
  Inflater inflater(path, bytes);
  std::string text;
  while (inflater.appendTo(text, kAtOnce))
    if (text.size() > maxGunzipped(bytes.size()))
      throw FileError(path, "expands to more than 100 times its size; if that is right, expand it with gunzip first");
  return text;
}

std::string gunzipStart(const std::filesystem::path& path, std::string_view bytes, std::size_t length) {
  std::string text;
  Inflater(path, bytes).appendTo(text, length);
  return text;
}

}  // namespace gaussmap::detail
