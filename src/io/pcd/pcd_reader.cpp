// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/pcd_reader.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "io/files/gunzip.h"
#include "io/files/mapped_file.h"
#include "io/pcd/pcd_body.h"
#include "io/pcd/pcd_header.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

/// One scalar per point, anywhere in memory and not aligned.
struct Scalars {
  const char* first = nullptr;
  std::size_t step = 0;  // bytes from point to point
  char type = 'F';
  std::size_t size = 8;
};

/// Calls body with a value of the C++ type of such scalars. Returns false if there is no such type.
template <typename Body>
bool withType(char type, std::size_t size, const Body& body) {
  const auto is = [type, size](char t, std::size_t s) { return type == t && size == s; };
  if (is('F', 4)) return body(float{}), true;
  if (is('F', 8)) return body(double{}), true;
  if (is('I', 1)) return body(std::int8_t{}), true;
  if (is('I', 2)) return body(std::int16_t{}), true;
  if (is('I', 4)) return body(std::int32_t{}), true;
  if (is('I', 8)) return body(std::int64_t{}), true;
  if (is('U', 1)) return body(std::uint8_t{}), true;
  if (is('U', 2)) return body(std::uint16_t{}), true;
  if (is('U', 4)) return body(std::uint32_t{}), true;
  if (is('U', 8)) return body(std::uint64_t{}), true;
  return false;
}

/// Converts scalars to doubles. Returns false if their type is unknown.
bool widen(const Scalars& scalars, std::size_t begin, std::size_t count, double* values) {
  return withType(scalars.type, scalars.size, [&](auto value) {
    const char* place = scalars.first + begin * scalars.step;
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&value, place + i * scalars.step, sizeof(value));
      values[i] = static_cast<double>(value);
    }
  });
}

/// Writes one element of a field, for every point, to `place` and every `record` bytes after it.
void narrow(const AsciiColumn& column, const PcdField& field, std::size_t record, char* place) {
  for (const std::uint64_t number : column.integers) {
    std::memcpy(place, &number, sizeof(number));
    place += record;
  }
  withType(field.type, field.size, [&](auto value) {
    for (const double number : column.values) {
      value = nearestOf<decltype(value)>(number);
      std::memcpy(place, &value, sizeof(value));
      place += record;
    }
  });
}

Scalars scalarsOf(const PcdField& field, std::size_t element, const char* bytes, PcdStride stride) {
  return {bytes + stride.offset + element * field.size, stride.step, field.type, field.size};
}

AsciiKind kindOf(const PcdField& field) {
  return field.type == 'F' && field.size == 4 ? AsciiKind::Single : AsciiKind::Double;
}

/// Like kindOf(), but doubles cannot hold every integer of 8 bytes.
AsciiKind exactKindOf(const PcdField& field) {
  if (field.size == 8 && field.type == 'I') return AsciiKind::Signed;
  if (field.size == 8 && field.type == 'U') return AsciiKind::Unsigned;
  return kindOf(field);
}

void requireNumbers(const std::filesystem::path& path, const PcdField& field) {
  if (!widen({nullptr, 0, field.type, field.size}, 0, 0, nullptr))
    throw FileError(path, "field '" + field.name + "' is TYPE " + field.type + " SIZE " + std::to_string(field.size) +
                              ", which gaussmap cannot read as a number");
}

/// Returns the expanded start of a gzip file, up to the end of the DATA line if possible.
std::string startOfGzip(const std::filesystem::path& path, std::string_view bytes) {
  constexpr std::size_t kUsualHeader = 4096, kLongestHeader = (std::size_t{1} << 20) + 1;
  std::string start = gunzipStart(path, bytes, kUsualHeader);
  const std::size_t data = start.find("\nDATA");
  if (data != std::string::npos && start.find('\n', data + 1) != std::string::npos) return start;
  return gunzipStart(path, bytes, kLongestHeader);
}

/// Throws FileError if a gzip file cannot hold the points that the header claims, even if it expands to `most` bytes.
/// After this check, a program can allocate memory for the points.
void checkClaim(const std::filesystem::path& path, const PcdHeader& header, std::size_t most) {
  const bool is_text = header.encoding == PcdEncoding::Ascii;
  std::size_t bytes = 0;
  if (header.columns > most ||
      __builtin_mul_overflow(header.points, is_text ? 2 * header.columns : header.record_size, &bytes) || bytes > most)
    throw FileError(path, "the header claims " + std::to_string(header.points) +
                              " points, more than 100 times the size of the gzip file; if that is right, expand it "
                              "with gunzip first");
}

}  // namespace

const PcdField* PcdHeader::find(const std::string& name) const {
  if (name == "_") return nullptr;
  for (const PcdField& field : fields)
    if (field.name == name) return &field;
  return nullptr;
}

struct PcdReader::Body {
  explicit Body(std::shared_ptr<const MappedFile> mapped) : file(std::move(mapped)) {}

  std::shared_ptr<const MappedFile> file;
  std::string_view data;  // after the header; of a gzip file: the whole file
  bool is_gzip = false;
  // The first read sets the positions of x, y and z, and the memory that holds them if it is not that of the file.
  std::mutex mutex;
  std::atomic<bool> loaded{false};
  std::array<Scalars, 3> axes;
  std::unique_ptr<char[]> expanded;
  std::string gunzipped;
  std::vector<AsciiColumn> parsed;

  /// Returns the data after the header. A gzip file is expanded into `room`. Throws FileError.
  std::string_view dataIn(std::string& room, const std::filesystem::path& path, const PcdHeader& header) const {
    if (!is_gzip) return data;
    room = gunzip(path, data);
    const std::string_view rest = std::string_view(room).substr(std::min(header.data_offset, room.size()));
    checkPcdBody(path, header, rest);
    return rest;
  }

  void load(const std::filesystem::path& path, const PcdHeader& header) {
    if (header.points == 0) return;  // then the offsets can lie outside the data
    const std::string_view bytes = dataIn(gunzipped, path, header);
    switch (header.encoding) {
      case PcdEncoding::Ascii:
        loadAscii(path, header, bytes);
        break;
      case PcdEncoding::Binary:
        return loadBinary(header, bytes);
      case PcdEncoding::BinaryCompressed:
        loadCompressed(path, header, bytes);
    }
    gunzipped = std::string();
  }

 private:
  void loadAscii(const std::filesystem::path& path, const PcdHeader& header, std::string_view bytes) {
    std::vector<AsciiColumn> columns;
    columns.reserve(kAxes.size());
    for (const char* const name : kAxes) columns.push_back({header.find(name)->column, kindOf(*header.find(name))});
    std::sort(columns.begin(), columns.end(),
              [](const AsciiColumn& a, const AsciiColumn& b) { return a.column < b.column; });
    parsePcdAscii(path, header, bytes, columns);
    parsed = std::move(columns);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const AsciiColumn& column : parsed)
        if (column.column == header.find(kAxes[axis])->column)
          axes[axis] = {reinterpret_cast<const char*>(column.values.data()), sizeof(double), 'F', sizeof(double)};
  }

  void loadBinary(const PcdHeader& header, std::string_view bytes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const PcdField& field = *header.find(kAxes[axis]);
      axes[axis] = scalarsOf(field, 0, bytes.data(), {field.offset, header.record_size});
    }
  }

  // Keeps only x, y and z of the expanded fields.
  void loadCompressed(const std::filesystem::path& path, const PcdHeader& header, std::string_view bytes) {
    const PcdExpanded all(path, header, bytes);
    std::size_t size = 0;
    for (const char* const name : kAxes) size += header.points * header.find(name)->size;
    std::unique_ptr<char[]> kept(new char[size]);
    std::size_t offset = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const PcdField& field = *header.find(kAxes[axis]);
      const std::size_t length = header.points * field.size;
      if (length > 0) std::memcpy(kept.get() + offset, all.bytes() + all.strideOf(field).offset, length);
      axes[axis] = {kept.get() + offset, field.size, field.type, field.size};
      offset += length;
    }
    expanded = std::move(kept);
  }
};

PcdReader::PcdReader(const std::filesystem::path& path)
    : path_(path), body_(std::make_unique<Body>(std::make_shared<const MappedFile>(path))) {
  const std::string_view bytes = body_->file->bytes();
  body_->is_gzip = detail::isGzip(bytes);
  if (body_->is_gzip) {
    body_->data = bytes;
    header_ = parsePcdHeader(path_, startOfGzip(path_, bytes));
    checkClaim(path_, header_, maxGunzipped(bytes.size()));
    return;
  }
  header_ = parsePcdHeader(path_, bytes);
  body_->data = body_->file->bytes().substr(header_.data_offset);
  checkPcdBody(path_, header_, body_->data);
}

PcdReader::PcdReader(std::filesystem::path path, PcdHeader header, std::unique_ptr<Body> body)
    : path_(std::move(path)), header_(std::move(header)), body_(std::move(body)) {}

PcdReader PcdReader::sameFile() const {
  auto body = std::make_unique<Body>(body_->file);
  body->data = body_->data;
  body->is_gzip = body_->is_gzip;
  return PcdReader(path_, header_, std::move(body));
}

PcdReader::~PcdReader() = default;
PcdReader::PcdReader(PcdReader&&) noexcept = default;
PcdReader& PcdReader::operator=(PcdReader&&) noexcept = default;

bool PcdReader::isGzip() const {
  return body_->is_gzip;
}

void PcdReader::requireWhole() const {
  body_->file->requireWhole();
}

void PcdReader::releasePages() const {
  body_->file->release();
}

void PcdReader::read(std::size_t first, PointBlock<3>& block) const {
  block.size = 0;
  if (!body_->loaded.load(std::memory_order_acquire)) {
    const std::lock_guard<std::mutex> lock(body_->mutex);
    if (!body_->loaded.load(std::memory_order_relaxed)) {
      body_->load(path_, header_);
      requireWhole();
    }
    body_->loaded.store(true, std::memory_order_release);
  }
  if (first >= size()) return;
  block.size = std::min(PointBlock<3>::kCapacity, size() - first);
  for (std::size_t axis = 0; axis < 3; ++axis) widen(body_->axes[axis], first, block.size, block.coordinate[axis]);
}

std::vector<std::vector<double>> PcdReader::columns(const std::vector<PcdColumn>& wanted) const {
  std::vector<const PcdField*> fields;
  for (const PcdColumn& column : wanted) {
    const PcdField* const field = header_.find(column.field);
    if (!field) throw FileError(path_, "has no field '" + column.field + "'");
    if (column.element >= field->count)
      throw FileError(path_, "field '" + column.field + "' has COUNT " + std::to_string(field->count) +
                                 ", so it has no element " + std::to_string(column.element));
    requireNumbers(path_, *field);
    fields.push_back(field);
  }

  std::vector<std::vector<double>> result(wanted.size());
  if (size() == 0) return result;
  std::string room;
  const std::string_view data = body_->dataIn(room, path_, header_);
  if (header_.encoding == PcdEncoding::Ascii) {
    std::vector<std::size_t> order(wanted.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto columnOf = [&](std::size_t i) { return fields[i]->column + wanted[i].element; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return columnOf(a) < columnOf(b); });
    std::vector<AsciiColumn> columns;
    columns.reserve(order.size());
    for (const std::size_t i : order) columns.push_back({columnOf(i), kindOf(*fields[i])});
    parsePcdAscii(path_, header_, data, columns);
    for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = std::move(columns[i].values);
    requireWhole();
    return result;
  }
  std::unique_ptr<const PcdExpanded> all;
  if (header_.encoding == PcdEncoding::BinaryCompressed)
    all = std::make_unique<const PcdExpanded>(path_, header_, data);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const PcdField& field = *fields[i];
    const PcdStride stride = all ? all->strideOf(field) : PcdStride{field.offset, header_.record_size};
    result[i].resize(size());
    widen(scalarsOf(field, wanted[i].element, all ? all->bytes() : data.data(), stride), 0, size(), result[i].data());
  }
  requireWhole();
  return result;
}

std::vector<double> PcdReader::column(const std::string& field, std::size_t element) const {
  return std::move(columns({{field, element}}).front());
}

std::vector<char> PcdReader::records() const {
  const std::size_t record = header_.record_size;
  std::vector<char> records(size() * record);
  if (records.empty()) return records;
  std::string room;
  const std::string_view data = body_->dataIn(room, path_, header_);
  switch (header_.encoding) {
    case PcdEncoding::Binary:
      std::memcpy(records.data(), data.data(), records.size());
      break;
    case PcdEncoding::BinaryCompressed: {
      const PcdExpanded all(path_, header_, data);
      for (const PcdField& field : header_.fields) {
        if (field.name == "_") continue;
        const PcdStride stride = all.strideOf(field);
        for (std::size_t i = 0; i < size(); ++i)
          std::memcpy(records.data() + i * record + field.offset, all.bytes() + stride.offset + i * stride.step,
                      field.size * field.count);
      }
      break;
    }
    case PcdEncoding::Ascii: {
      std::vector<AsciiColumn> columns;
      for (const PcdField& field : header_.fields) {
        if (field.name == "_") continue;
        requireNumbers(path_, field);
        for (std::size_t element = 0; element < field.count; ++element)
          columns.push_back({field.column + element, exactKindOf(field)});
      }
      parsePcdAscii(path_, header_, data, columns);
      auto column = columns.begin();
      for (const PcdField& field : header_.fields)
        for (std::size_t element = 0; field.name != "_" && element < field.count; ++element, ++column)
          narrow(*column, field, record, records.data() + field.offset + element * field.size);
    }
  }
  requireWhole();
  return records;
}

std::uint64_t PcdReader::fingerprint() const {
  // The samples are spread over the whole file, because organised clouds can start with rows of NaN.
  constexpr std::size_t kSamples = 16;
  constexpr std::size_t kSampleBytes = 256;
  constexpr std::uint64_t kPrime = 0x100000001B3ull;  // FNV-1a
  std::uint64_t hash = (0xCBF29CE484222325ull ^ header_.points) * kPrime;
  const std::string_view data = body_->data;
  const std::size_t step = std::max(data.size() / kSamples, kSampleBytes);
  for (std::size_t first = 0; first < data.size(); first += step)
    for (const char byte : data.substr(first, kSampleBytes)) hash = (hash ^ static_cast<unsigned char>(byte)) * kPrime;
  return hash;
}

}  // namespace gaussmap
