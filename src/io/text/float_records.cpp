// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/float_records.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/text/record_layout.h"
#include "io/text/text_layout.h"

namespace gaussmap::detail {
namespace {

struct OpenRecords {
  std::filesystem::path path;
  std::shared_ptr<const MappedFile> file;
  RecordLayout record;
  PointLayout layout;
  bool guessed = false;

  std::size_t count() const { return file->bytes().size() / record.size; }
};

class RecordsReader : public ScanReader {
 public:
  explicit RecordsReader(std::shared_ptr<const OpenRecords> records) : records_(std::move(records)) {}

  std::size_t size() const override { return records_->count(); }

  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(size() - first, PointBlock<3>::kCapacity) : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double* const values = block.coordinate[axis];
      readInto(records_->layout.coordinates[axis], first, block.size, values);
      if (const double divisor = records_->layout.divisors[axis]; divisor != 1.0)
        for (std::size_t i = 0; i < block.size; ++i) values[i] /= divisor;
    }
  }
  void requireWhole() const override { records_->file->requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PointValue& value : records_->layout.values) names.push_back(value.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PointValue& value : records_->layout.values) {
      if (value.name != name) continue;
      std::vector<std::vector<double>> columns;
      for (const std::size_t column : value.columns) {
        columns.emplace_back(size());
        readInto(column, 0, size(), columns.back().data());
      }
      return makeValue(records_->path, value, std::move(columns));
    }
    return ScanReader::values(name);
  }

 private:
  void readInto(std::size_t field, std::size_t first, std::size_t count, double* values) const {
    if (count > 0) readField(records_->record, field, records_->file->bytes(), first, count, values);
  }

  std::shared_ptr<const OpenRecords> records_;
};

class FloatRecords : public ScanFile {
 public:
  explicit FloatRecords(std::shared_ptr<const OpenRecords> records) : records_(std::move(records)) {}

  std::string kind() const override {
    const std::string fields = describe(records_->record);
    if (!records_->guessed) return "raw records, " + fields;
    return (records_->record.fields.size() == 4 ? "raw records of KITTI, " : "raw records of nuScenes, ") + fields;
  }
  std::size_t size() const override { return 1; }
  FileScanInfo info(std::size_t) const override { return {"", records_->count()}; }
  std::unique_ptr<ScanReader> open(std::size_t) const override { return std::make_unique<RecordsReader>(records_); }
  std::size_t memoryOf(std::size_t) const override { return 0; }
  void releasePages() const override { records_->file->release(); }
  std::vector<std::string> warnings() const override { return records_->layout.warnings; }

 private:
  std::shared_ptr<const OpenRecords> records_;
};

/// Warns if the coordinates cannot be metres, because then the fields are probably wrong.
void warnOfWildCoordinates(OpenRecords& records, const std::vector<ColumnSample>& samples) {
  constexpr double kLargest = 1e8, kSmallest = 1e-30;
  for (const std::size_t column : records.layout.coordinates)
    for (const double value : samples[column].values) {
      const double size = std::abs(value / records.record.fields[column].divisor);
      if (!(size > kLargest || (size > 0.0 && size < kSmallest))) continue;
      records.layout.warnings.push_back(
          "some coordinates are larger than 1e8 m or smaller than 1e-30 m: are the "
          "fields " +
          describe(records.record) + " right?");
      return;
    }
}

/// Warns if the records look like those of a dataset, but the given fields have another size.
void warnOfLikelierRecord(OpenRecords& records) {
  const std::string likely = likelyRecord(records.file->bytes());
  if (likely.empty() || RecordLayout(parseFields(likely, true)).size == records.record.size) return;
  records.layout.warnings.push_back("the content looks like --fields \"" + likely + "\", not like " +
                                    describe(records.record));
}

}  // namespace

std::unique_ptr<ScanFile> openFloatRecords(const std::filesystem::path& path, const FloatRecordsOptions& options) {
  std::vector<PointField> fields;
  if (!options.fields.empty()) fields = parseFields(options.fields, true);
  auto file = std::make_shared<const MappedFile>(path);
  const std::string_view bytes = file->bytes();
  if (bytes.empty()) throw FileError(path, "the file is empty");
  refuseOtherKinds(path, bytes);
  const bool guessed = fields.empty();
  if (guessed) fields = guessRecord(path, bytes);
  RecordLayout record(std::move(fields));
  if (bytes.size() % record.size != 0)
    throw FileError(path, std::to_string(bytes.size()) + " bytes are not a multiple of " + std::to_string(record.size) +
                              ", the size of a record " + describe(record) +
                              ": the file is cut off, or the fields are wrong; correct them with --fields");
  const std::vector<ColumnSample> samples = sampleRecords(record, bytes);
  PointLayout layout = layOutFields(record.fields, samples);
  auto records =
      std::make_shared<OpenRecords>(OpenRecords{path, std::move(file), std::move(record), std::move(layout), guessed});
  warnOfWildCoordinates(*records, samples);
  if (!guessed) warnOfLikelierRecord(*records);
  return std::make_unique<FloatRecords>(std::move(records));
}

}  // namespace gaussmap::detail
