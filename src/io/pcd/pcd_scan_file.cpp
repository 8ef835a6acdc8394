// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_scan_file.h"

#include <algorithm>
#include <utility>

namespace gaussmap::detail {
namespace {

/// Returns the name of a field element in the interface ScanReader: "intensity", or "normal[0]" if the field
/// has several elements.
std::string valueName(const PcdField& field, std::size_t element) {
  return field.count == 1 ? field.name : field.name + "[" + std::to_string(element) + "]";
}

class PcdScanReader : public ScanReader {
 public:
  explicit PcdScanReader(PcdReader reader) : reader_(std::move(reader)) {}

  std::size_t size() const override { return reader_.size(); }
  int columns() const override {
    const PcdHeader& header = reader_.header();
    return header.height > 1 ? static_cast<int>(header.width) : 0;
  }
  void read(std::size_t first, PointBlock<3>& block) const override { reader_.read(first, block); }
  void requireWhole() const override { reader_.requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PcdField& field : reader_.header().fields)
      for (std::size_t element = 0; isValue(field) && element < field.count; ++element)
        if (const std::string name = valueName(field, element);
            std::find(names.begin(), names.end(), name) == names.end())
          names.push_back(name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PcdField& field : reader_.header().fields)
      for (std::size_t element = 0; isValue(field) && element < field.count; ++element)
        if (valueName(field, element) == name) return reader_.column(field.name, element);
    return ScanReader::values(name);
  }

 private:
  static bool isValue(const PcdField& field) {
    return field.name != "x" && field.name != "y" && field.name != "z" && field.name != "_";
  }

  PcdReader reader_;
};

}  // namespace

std::string PcdScanFile::kind() const {
  const PcdHeader& header = reader_.header();
  const char* const encoding = header.encoding == PcdEncoding::Ascii    ? "ascii"
                               : header.encoding == PcdEncoding::Binary ? "binary"
                                                                        : "binary_compressed";
  return std::string("PCD ") + encoding + (header.height > 1 ? ", organised" : "");
}

FileScanInfo PcdScanFile::info(std::size_t) const {
  const PcdHeader& header = reader_.header();
  return {"",           reader_.size(),        header.viewpoint,     std::nullopt,
          std::nullopt, header.viewpoint_step, reader_.fingerprint()};
}

std::unique_ptr<ScanReader> PcdScanFile::open(std::size_t) const {
  return std::make_unique<PcdScanReader>(reader());
}

std::size_t PcdScanFile::memoryOf(std::size_t) const {
  const PcdHeader& header = reader_.header();
  if (header.encoding == PcdEncoding::Binary && !reader_.isGzip()) return 0;
  return std::max(3 * sizeof(double), header.record_size) * header.points;  // at most
}

std::unique_ptr<PcdScanFile> openPcd(const std::filesystem::path& path) {
  PcdReader reader(path);
  if (reader.header().find("covariance") != nullptr && reader.header().find("cell_side") != nullptr)
    throw FileError(path,
                    "holds the Gaussians of a map, not the points of a scan; a directory of such tiles becomes a map "
                    "with gaussmap tiles DIR -o MAP");
  return std::make_unique<PcdScanFile>(std::move(reader));
}

}  // namespace gaussmap::detail
