// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/text_lines.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "io/files/mapped_file.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;
constexpr std::size_t kLongestLine = std::size_t{1} << 24;
constexpr std::string_view kGzipMagic = "\x1F\x8B";
constexpr int kGzipOnly = 15 + 16;  // zlib: the largest window, a gzip header

bool startsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

}  // namespace

/// Source of the bytes of a text.
struct TextLines::Source {
  virtual ~Source() = default;
  /// Replaces `piece` by the next bytes, which are empty at the end. Sets `damage` if the end comes too early.
  virtual void read(std::string& piece, std::string& damage) = 0;
};

struct TextLines::PlainSource : Source {
  explicit PlainSource(std::unique_ptr<MappedFile> text) : file(std::move(text)), rest(file->bytes()) {}

  void read(std::string& piece, std::string&) override {
    piece = rest.substr(0, kPiece);
    file->requireWhole();
    rest.remove_prefix(piece.size());
  }

  std::unique_ptr<MappedFile> file;
  std::string_view rest;
};

struct TextLines::GzipSource : Source {
  explicit GzipSource(std::unique_ptr<MappedFile> compressed) : file(std::move(compressed)), rest(file->bytes()) {
    if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~GzipSource() override { inflateEnd(&stream); }
  GzipSource(const GzipSource&) = delete;
  GzipSource& operator=(const GzipSource&) = delete;

  void read(std::string& piece, std::string& damage) override {
    piece.resize(kPiece);
    std::size_t filled = 0;
    while (filled == 0 && !ended) filled = expand(piece, damage);
    file->requireWhole();
    piece.resize(filled);
  }

  /// Expands bytes into `piece` and returns their number. Bytes before damaged data are included.
  std::size_t expand(std::string& piece, std::string& damage) {
    const std::size_t given = std::min(rest.size(), kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest.data()));  // zlib does not write there
    stream.avail_in = static_cast<uInt>(given);
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    const int state = inflate(&stream, Z_NO_FLUSH);
    rest.remove_prefix(given - stream.avail_in);
    const std::size_t filled = piece.size() - stream.avail_out;
    if (state == Z_STREAM_END) {
      ended = !startsWith(rest, kGzipMagic);  // several gzip files may be joined
      if (!ended) inflateReset(&stream);
      if (ended && rest.find_first_not_of('\0') != std::string_view::npos)
        damage = "there are " + std::to_string(rest.size()) + " bytes after the gzip data";
    } else if (state == Z_BUF_ERROR || (state == Z_OK && rest.empty() && filled == 0)) {
      ended = true;
      damage = "the gzip data end too early: the file was cut off";
    } else if (state != Z_OK) {
      ended = true;
      damage = std::string("the gzip data are damaged at byte ") + std::to_string(file->bytes().size() - rest.size()) +
               (stream.msg ? std::string(": ") + stream.msg : "");
    }
    return filled;
  }

  std::unique_ptr<MappedFile> file;
  std::string_view rest;
  z_stream stream{};
  bool ended = false;
};

TextLines::TextLines(const std::filesystem::path& path) {
  auto file = std::make_unique<MappedFile>(path);
  if (startsWith(file->bytes(), kGzipMagic)) {
    source_ = std::make_unique<GzipSource>(std::move(file));
  } else {
    source_ = std::make_unique<PlainSource>(std::move(file));
  }
}

TextLines::~TextLines() = default;

bool TextLines::next(std::string& line) {
  line.clear();
  ++number_;
  bool begun = false;
  while (true) {
    if (read_ == buffer_.size()) {
      read_ = 0;
      source_->read(buffer_, damage_);
      if (buffer_.empty()) return begun && damage_.empty();  // a line cut off by the damage is dropped
    }
    begun = true;
    const std::string_view rest = std::string_view(buffer_).substr(read_);
    const std::size_t end = rest.find('\n');
    const std::string_view piece = rest.substr(0, end);
    line += piece.substr(0, kLongestLine - line.size());
    read_ += piece.size() + (end != std::string_view::npos ? 1 : 0);
    if (end != std::string_view::npos) return true;
  }
}

}  // namespace gaussmap::detail
