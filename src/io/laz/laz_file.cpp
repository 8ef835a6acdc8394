// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/laz_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "io/files/mapped_file.h"
#include "io/las/las_box.h"
#include "io/las/las_bytes.h"
#include "io/las/las_points.h"

namespace gaussmap::detail {

namespace {

using Coordinates = std::array<std::int32_t, 3>;

/// Throws FileError if the file is too small for the points that the header claims. Points can need less than a bit
/// each, so the limit is only one of memory, like that of gzip files.
void checkPointClaim(const std::filesystem::path& path, std::size_t bytes, const LasHeader& header) {
  constexpr std::size_t kFree = std::size_t{16} << 20, kRatio = 100;
  if (header.points > (kFree + kRatio * bytes) / sizeof(Coordinates))
    throw FileError(path, "the header says " + std::to_string(header.points) + " points, but the file has only " +
                              std::to_string(bytes) +
                              " bytes; if that is right, expand it with 'laszip -i in.laz -o out.las' first");
}

/// Returns the layers that hold a value, from its position in the record of formats 6 to 10.
unsigned layersOf(const LasHeader& header, const LasField& field) {
  struct Range {
    std::size_t end;
    unsigned layers;
  };
  constexpr std::array<Range, 10> kRanges = {{{14, kLazIntensity},
                                              {15, 0},
                                              {16, kLazFlags},
                                              {17, kLazClassification},
                                              {18, kLazUserData},
                                              {20, kLazScanAngle},
                                              {22, kLazPointSource},
                                              {30, kLazGpsTime},
                                              {36, kLazColour},
                                              {38, kLazInfrared}}};
  if (field.offset >= lasRecordLength(header.point_format)) return kLazExtraBytes;
  const auto range = std::find_if(kRanges.begin(), kRanges.end(), [&](const Range& r) { return field.offset < r.end; });
  return range == kRanges.end() ? kAllLazLayers : range->layers;
}

class LazReader : public ScanReader {
 public:
  LazReader(std::shared_ptr<const LazSource> source, std::vector<LasField> fields)
      : source_(std::move(source)), fields_(std::move(fields)) {}

  std::size_t size() const override { return source_->header.points; }

  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = 0;
    if (first >= size()) return;
    load();
    block.size = std::min(PointBlock<3>::kCapacity, size() - first);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = source_->header.scale[static_cast<Eigen::Index>(axis)];
      const double offset = source_->header.offset[static_cast<Eigen::Index>(axis)];
      for (std::size_t i = 0; i < block.size; ++i)
        block.coordinate[axis][i] = points_[first + i][axis] * scale + offset;
    }
  }

  void requireWhole() const override { source_->file->requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    names.reserve(fields_.size());
    for (const LasField& field : fields_) names.push_back(field.name);
    return names;
  }

  std::vector<double> values(const std::string& name) const override {
    const auto field =
        std::find_if(fields_.begin(), fields_.end(), [&](const LasField& each) { return each.name == name; });
    if (field == fields_.end()) return ScanReader::values(name);
    std::vector<double> values;
    values.reserve(size());
    decodeLaz(*source_, layersOf(source_->header, *field), [&](const char* records, std::size_t count) {
      values.resize(values.size() + count);
      decodeLasField(*field, source_->header.record_length, records, count, values.data() + (values.size() - count));
    });
    if (field->kind == LasField::Kind::Colour) finishLasColours(values);
    return values;
  }

 private:
  void load() const {
    if (is_loaded_.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_loaded_.load(std::memory_order_relaxed)) return;
    std::vector<Coordinates> points;
    points.reserve(size());
    decodeLaz(*source_, kLazZ, [&](const char* records, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i)
        points.push_back(lasNumber<Coordinates>(records + i * source_->header.record_length));
    });
    points_ = std::move(points);
    is_loaded_.store(true, std::memory_order_release);
  }

  std::shared_ptr<const LazSource> source_;
  std::vector<LasField> fields_;
  mutable std::mutex mutex_;
  mutable std::atomic<bool> is_loaded_{false};
  mutable std::vector<Coordinates> points_;
};

class LazFile : public ScanFile {
 public:
  explicit LazFile(std::shared_ptr<const LazSource> source) : source_(std::move(source)) {
    warnings_ = source_->header.warnings;
    std::string warning;
    fields_ = lasFields(source_->header, warning);
    for (const std::string& text : {source_->chunks.warning, warning})
      if (!text.empty()) warnings_.push_back(text);
  }

  std::string kind() const override {
    const LasHeader& header = source_->header;
    const std::string version = "LAZ 1." + std::to_string(header.minor_version);
    return (header.find("copc", 1) != nullptr ? "COPC (" + version + ")" : version) + ", point format " +
           std::to_string(header.point_format);
  }
  std::size_t size() const override { return 1; }
  FileScanInfo info(std::size_t /*scan*/) const override { return {"", source_->header.points}; }
  std::unique_ptr<ScanReader> open(std::size_t /*scan*/) const override {
    return std::make_unique<LazReader>(source_, fields_);
  }
  bool inMapFrame() const override { return true; }
  void releasePages() const override { source_->file->release(); }
  std::string coordinateSystem() const override { return source_->header.crs.text; }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = warnings_;
    // Only the first point is not compressed.
    const std::string_view first = source_->file->bytes().substr(source_->chunks.first_byte);
    const std::size_t count =
        first.size() < source_->header.record_length ? 0 : std::min<std::size_t>(source_->header.points, 1);
    for (std::string& warning : lasBoxWarnings(source_->header, first.data(), count))
      warnings.push_back(std::move(warning));
    return warnings;
  }

 private:
  std::shared_ptr<const LazSource> source_;
  std::vector<LasField> fields_;
  std::vector<std::string> warnings_;
};

}  // namespace

bool isLaz(std::string_view start) {
  constexpr std::size_t kFormatByte = 104;
  constexpr int kCompressionBits = 0xC0;
  return hasLasSignature(start) && start.size() > kFormatByte && (start[kFormatByte] & kCompressionBits) != 0;
}

std::shared_ptr<const LazSource> openLazSource(const std::filesystem::path& path) {
  auto source = std::make_shared<LazSource>();
  source->path = path;
  source->file = std::make_shared<const MappedFile>(path);
  const std::string_view bytes = source->file->bytes();
  source->header = parseLasHeader(path, bytes);
  source->layout = parseLazLayout(path, source->header);
  refuseLasDegrees(path, source->header);
  checkPointClaim(path, bytes.size(), source->header);
  source->chunks = findLazChunks(path, bytes, source->header, source->layout);
  return source;
}

std::unique_ptr<ScanFile> openLaz(const std::filesystem::path& path) {
  return std::make_unique<LazFile>(openLazSource(path));
}

}  // namespace gaussmap::detail
