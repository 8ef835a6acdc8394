// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_file.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/las/las_box.h"
#include "io/las/las_header.h"
#include "io/las/las_points.h"

namespace gaussmap::detail {
namespace {

/// An open file and what its header says.
struct OpenLas {
  explicit OpenLas(const std::filesystem::path& path) : file(path), header(parseLasHeader(path, file.bytes())) {
    if (header.compression != 0)
      throw FileError(path,
                      "the points are compressed (byte 104), which LAS files are not: is this a LAZ file? Convert it "
                      "with pdal translate IN.laz OUT.las");
    checkLasPoints(path, file.bytes(), header);
    refuseLasDegrees(path, header);
    std::string warning;
    fields = lasFields(header, warning);
    if (!warning.empty()) header.warnings.push_back(warning);
  }
  std::size_t size() const { return static_cast<std::size_t>(header.points); }
  const char* records() const { return file.bytes().data() + header.data_offset; }

  MappedFile file;
  LasHeader header;
  std::vector<LasField> fields;
};

class LasScanReader : public ScanReader {
 public:
  explicit LasScanReader(std::shared_ptr<const OpenLas> las) : las_(std::move(las)) {}

  std::size_t size() const override { return las_->size(); }
  void read(std::size_t first, PointBlock<3>& block) const override {
    const std::size_t count = first < size() ? std::min(PointBlock<3>::kCapacity, size() - first) : 0;
    block.size = count;
    if (count > 0) decodeLasPoints(las_->header, las_->records() + first * las_->header.record_length, count, block);
  }
  void requireWhole() const override { las_->file.requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    names.reserve(las_->fields.size());
    for (const LasField& field : las_->fields) names.push_back(field.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const LasField& field : las_->fields) {
      if (field.name != name) continue;
      std::vector<double> values(size());
      decodeLasField(field, las_->header.record_length, las_->records(), size(), values.data());
      if (field.kind == LasField::Kind::Colour) finishLasColours(values);
      requireWhole();
      return values;
    }
    return ScanReader::values(name);
  }

 private:
  std::shared_ptr<const OpenLas> las_;
};

class LasFile : public ScanFile {
 public:
  explicit LasFile(const std::filesystem::path& path) : las_(std::make_shared<const OpenLas>(path)) {}

  std::string kind() const override {
    return "LAS 1." + std::to_string(las_->header.minor_version) + ", point format " +
           std::to_string(las_->header.point_format);
  }
  std::size_t size() const override { return 1; }
  FileScanInfo info(std::size_t) const override { return {"", las_->size()}; }
  std::unique_ptr<ScanReader> open(std::size_t) const override { return std::make_unique<LasScanReader>(las_); }
  bool inMapFrame() const override { return true; }
  std::string coordinateSystem() const override { return las_->header.crs.text; }
  std::size_t memoryOf(std::size_t) const override { return 0; }
  void releasePages() const override { las_->file.release(); }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = las_->header.warnings;
    for (std::string& warning : lasBoxWarnings(las_->header, las_->records(), las_->size()))
      warnings.push_back(std::move(warning));
    return warnings;
  }

 private:
  std::shared_ptr<const OpenLas> las_;
};

}  // namespace

bool isLas(std::string_view start) {
  constexpr std::size_t kFormatByte = 104;
  constexpr int kCompressionBits = 0xC0;
  return hasLasSignature(start) && (start.size() <= kFormatByte || (start[kFormatByte] & kCompressionBits) == 0);
}

std::unique_ptr<ScanFile> openLas(const std::filesystem::path& path) {
  return std::make_unique<LasFile>(path);
}

}  // namespace gaussmap::detail
