// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_cloud.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <mutex>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/ply/ply_header.h"
#include "io/ply/ply_names.h"
#include "io/ply/ply_vertices.h"

namespace gaussmap::detail {
namespace {

/// An open file and what its header says.
struct OpenPly {
  explicit OpenPly(const std::filesystem::path& path)
      : file(path), vertices(path, parsePlyHeader(path, file.bytes()), file.bytes()) {
    std::string error;
    meaning = meaningOf(vertices.vertex(), error);
    if (!error.empty())
      throw FileError(path, "line " + std::to_string(vertices.vertex().line) + ": element 'vertex': " + error);
  }

  MappedFile file;
  PlyVertices vertices;
  PlyMeaning meaning;
};

/// Returns the columns of some properties in the given order, which does not need to be ascending.
std::vector<std::vector<double>> columnsOf(const PlyVertices& vertices, const std::vector<std::size_t>& properties) {
  std::vector<std::size_t> order(properties.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return properties[a] < properties[b]; });
  std::vector<std::size_t> sorted;
  sorted.reserve(order.size());
  for (const std::size_t i : order) sorted.push_back(properties[i]);
  std::vector<std::vector<double>> columns = vertices.columns(sorted);
  std::vector<std::vector<double>> result(properties.size());
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = std::move(columns[i]);
  return result;
}

class PlyScanReader : public ScanReader {
 public:
  explicit PlyScanReader(std::shared_ptr<const OpenPly> ply) : ply_(std::move(ply)) {}

  std::size_t size() const override { return ply_->vertices.size(); }
  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(PointBlock<3>::kCapacity, size() - first) : 0;
    if (block.size == 0) return;
    const std::array<std::size_t, 3>& axes = ply_->meaning.axes;
    if (ply_->vertices.hasRecords()) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        ply_->vertices.decode(axes[axis], first, block.size, block.coordinate[axis]);
      return;
    }
    load();
    for (std::size_t axis = 0; axis < 3; ++axis)
      std::memcpy(block.coordinate[axis], coordinates_[axis].data() + first, block.size * sizeof(double));
  }
  void requireWhole() const override { ply_->file.requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PlyValue& value : ply_->meaning.values) names.push_back(value.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PlyValue& value : ply_->meaning.values) {
      if (value.name != name) continue;
      std::vector<std::vector<double>> columns = columnsOf(ply_->vertices, value.properties);
      requireWhole();
      if (columns.size() == 1) return std::move(columns.front());
      const NumberType type = ply_->vertices.vertex().properties[value.properties.front()].type;
      return packColours({std::move(columns[0]), std::move(columns[1]), std::move(columns[2])}, !isWhole(type));
    }
    return ScanReader::values(name);
  }

 private:
  /// Parses the coordinates of a file whose vertices have no constant size. The reader keeps them.
  void load() const {
    if (is_loaded_.load(std::memory_order_acquire)) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_loaded_.load(std::memory_order_relaxed)) return;
    const std::array<std::size_t, 3>& axes = ply_->meaning.axes;
    coordinates_ = columnsOf(ply_->vertices, {axes.begin(), axes.end()});
    requireWhole();
    is_loaded_.store(true, std::memory_order_release);
  }

  std::shared_ptr<const OpenPly> ply_;
  mutable std::mutex mutex_;
  mutable std::atomic<bool> is_loaded_{false};
  mutable std::vector<std::vector<double>> coordinates_;
};

class PlyCloud : public ScanFile {
 public:
  explicit PlyCloud(const std::filesystem::path& path) : ply_(std::make_shared<const OpenPly>(path)) {}

  std::string kind() const override {
    constexpr std::array<const char*, 3> kNames = {"ascii", "binary_little_endian", "binary_big_endian"};
    return std::string("PLY ") + kNames[static_cast<std::size_t>(ply_->vertices.encoding())];
  }
  std::size_t size() const override { return 1; }
  FileScanInfo info(std::size_t) const override { return {"", ply_->vertices.size()}; }
  std::unique_ptr<ScanReader> open(std::size_t) const override { return std::make_unique<PlyScanReader>(ply_); }
  void releasePages() const override { ply_->file.release(); }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings;
    const PlyVertices& vertices = ply_->vertices;
    for (const std::size_t axis : ply_->meaning.axes)
      if (const PlyProperty& property = vertices.vertex().properties[axis]; isWhole(property.type)) {
        warnings.push_back("the coordinate " + property.name + " is a whole number, which is taken as metres");
        break;
      }
    if (vertices.hasRecords() && vertices.bytesBehind() >= vertices.recordSize())
      warnings.push_back("the header says " + std::to_string(vertices.size()) + " vertices, but there is room for " +
                         std::to_string(vertices.size() + vertices.bytesBehind() / vertices.recordSize()) +
                         ": the others are not read");
    const std::vector<PlyProperty>& properties = vertices.vertex().properties;
    const auto has = [&](const char* name) {
      return std::any_of(properties.begin(), properties.end(),
                         [name](const PlyProperty& property) { return property.name == name; });
    };
    if (const std::size_t faces = vertices.faces(); faces > 0)
      warnings.push_back("the file is a mesh with " + std::to_string(faces) +
                         " faces: its vertices are used as points, and the faces are ignored");
    if (vertices.hasElement("camera"))
      warnings.push_back("the pose in the element camera, as PCL writes it, is not used; give poses with --poses FILE");
    if (has("scale_0") && has("rot_0"))
      warnings.push_back("the vertices are Gaussians (scale_0, rot_0), not points: only their centres are used");
    return warnings;
  }

 private:
  std::shared_ptr<const OpenPly> ply_;
};

}  // namespace

bool isPly(std::string_view start) {
  constexpr std::string_view kSignature = "ply";
  return start.substr(0, kSignature.size()) == kSignature &&
         (start.size() == kSignature.size() || isBlank(start[kSignature.size()]) || start[kSignature.size()] == '\n');
}

std::unique_ptr<ScanFile> openPlyCloud(const std::filesystem::path& path) {
  return std::make_unique<PlyCloud>(path);
}

}  // namespace gaussmap::detail
