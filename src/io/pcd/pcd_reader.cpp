// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/pcd_reader.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <mutex>
#include <numeric>
#include <type_traits>
#include <utility>

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

/// Converts a number to T. If an integer type cannot hold the number, the result is the nearest limit of the type (NaN:
/// the minimum), because a cast would be undefined behaviour.
template <typename T>
T rounded(double number) {
  if constexpr (std::is_integral_v<T>) {
    using Limits = std::numeric_limits<T>;
    if (!(number > static_cast<double>(Limits::min()))) return Limits::min();
    if (number >= static_cast<double>(Limits::max())) return Limits::max();
  }
  return static_cast<T>(number);
}

/// Writes one element of a field, for every point, into records of DATA binary.
void narrow(const std::vector<double>& values, const PcdField& field, std::size_t element, std::size_t record,
            char* records) {
  withType(field.type, field.size, [&](auto value) {
    char* place = records + field.offset + element * field.size;
    for (const double number : values) {
      value = rounded<decltype(value)>(number);
      std::memcpy(place, &value, sizeof(value));
      place += record;
    }
  });
}

Scalars scalarsOf(const PcdField& field, std::size_t element, const char* bytes, PcdStride stride) {
  return {bytes + stride.offset + element * field.size, stride.step, field.type, field.size};
}

bool isSingle(const PcdField& field) {
  return field.type == 'F' && field.size == 4;
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
  std::string_view data;
  // The first read sets the positions of x, y and z, and the memory that holds them if it is not that of the file.
  std::mutex mutex;
  std::atomic<bool> loaded{false};
  std::array<Scalars, 3> axes;
  std::unique_ptr<char[]> expanded;
  std::vector<AsciiColumn> parsed;

  void load(const std::filesystem::path& path, const PcdHeader& header) {
    if (header.points == 0) return;  // then the offsets can lie outside the data
    switch (header.encoding) {
      case PcdEncoding::Ascii:
        return loadAscii(path, header);
      case PcdEncoding::Binary:
        return loadBinary(header);
      case PcdEncoding::BinaryCompressed:
        return loadCompressed(path, header);
    }
  }

 private:
  void loadAscii(const std::filesystem::path& path, const PcdHeader& header) {
    std::vector<AsciiColumn> columns;
    columns.reserve(kAxes.size());
    for (const char* const name : kAxes) columns.push_back({header.find(name)->column, isSingle(*header.find(name))});
    std::sort(columns.begin(), columns.end(),
              [](const AsciiColumn& a, const AsciiColumn& b) { return a.column < b.column; });
    parsePcdAscii(path, header, data, columns);
    parsed = std::move(columns);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const AsciiColumn& column : parsed)
        if (column.column == header.find(kAxes[axis])->column)
          axes[axis] = {reinterpret_cast<const char*>(column.values.data()), sizeof(double), 'F', sizeof(double)};
  }

  void loadBinary(const PcdHeader& header) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const PcdField& field = *header.find(kAxes[axis]);
      axes[axis] = scalarsOf(field, 0, data.data(), {field.offset, header.record_size});
    }
  }

  // Keeps only x, y and z of the expanded fields.
  void loadCompressed(const std::filesystem::path& path, const PcdHeader& header) {
    const PcdExpanded all(path, header, data);
    std::size_t bytes = 0;
    for (const char* const name : kAxes) bytes += header.points * header.find(name)->size;
    std::unique_ptr<char[]> kept(new char[bytes]);
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
  header_ = parsePcdHeader(path_, body_->file->bytes());
  body_->data = body_->file->bytes().substr(header_.data_offset);
  checkPcdBody(path_, header_, body_->data);
}

PcdReader::PcdReader(std::filesystem::path path, PcdHeader header, std::unique_ptr<Body> body)
    : path_(std::move(path)), header_(std::move(header)), body_(std::move(body)) {}

PcdReader PcdReader::sameFile() const {
  auto body = std::make_unique<Body>(body_->file);
  body->data = body_->data;
  return PcdReader(path_, header_, std::move(body));
}

PcdReader::~PcdReader() = default;
PcdReader::PcdReader(PcdReader&&) noexcept = default;
PcdReader& PcdReader::operator=(PcdReader&&) noexcept = default;

void PcdReader::requireWhole() const {
  body_->file->requireWhole();
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
    if (!widen({nullptr, 0, field->type, field->size}, 0, 0, nullptr))
      throw FileError(path_, "field '" + column.field + "' is TYPE " + field->type + " SIZE " +
                                 std::to_string(field->size) + ", which gaussmap cannot read as a number");
    fields.push_back(field);
  }

  std::vector<std::vector<double>> result(wanted.size());
  if (size() == 0) return result;
  if (header_.encoding == PcdEncoding::Ascii) {
    std::vector<std::size_t> order(wanted.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto columnOf = [&](std::size_t i) { return fields[i]->column + wanted[i].element; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return columnOf(a) < columnOf(b); });
    std::vector<AsciiColumn> columns;
    columns.reserve(order.size());
    for (const std::size_t i : order) columns.push_back({columnOf(i), isSingle(*fields[i])});
    parsePcdAscii(path_, header_, body_->data, columns);
    for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = std::move(columns[i].values);
    requireWhole();
    return result;
  }
  std::unique_ptr<const PcdExpanded> all;
  if (header_.encoding == PcdEncoding::BinaryCompressed)
    all = std::make_unique<const PcdExpanded>(path_, header_, body_->data);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const PcdField& field = *fields[i];
    const PcdStride stride = all ? all->strideOf(field) : PcdStride{field.offset, header_.record_size};
    result[i].resize(size());
    widen(scalarsOf(field, wanted[i].element, all ? all->bytes() : body_->data.data(), stride), 0, size(),
          result[i].data());
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
  switch (header_.encoding) {
    case PcdEncoding::Binary:
      std::memcpy(records.data(), body_->data.data(), records.size());
      break;
    case PcdEncoding::BinaryCompressed: {
      const PcdExpanded all(path_, header_, body_->data);
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
      std::vector<PcdColumn> wanted;
      for (const PcdField& field : header_.fields)
        for (std::size_t element = 0; field.name != "_" && element < field.count; ++element)
          wanted.push_back({field.name, element});
      const std::vector<std::vector<double>> values = columns(wanted);
      for (std::size_t i = 0; i < wanted.size(); ++i)
        narrow(values[i], *header_.find(wanted[i].field), wanted[i].element, record, records.data());
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
