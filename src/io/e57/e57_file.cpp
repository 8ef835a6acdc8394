// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_file.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/e57/e57_scan_reader.h"
#include "io/e57/e57_xml.h"

namespace gaussmap::detail {
namespace {

std::string readXml(const E57Pages& pages) {
  // 64 MiB are enough for about 16000 scans. The limit bounds the memory of the parser.
  constexpr std::uint64_t kLongest = std::uint64_t{64} << 20;
  const std::uint64_t bytes = pages.header().xml_bytes;
  const std::uint64_t offset = pages.logicalOffset(pages.header().xml_offset, bytes, "the XML section");
  if (bytes > kLongest)
    throw FileError(pages.path(), "the XML section has " + std::to_string(bytes) + " bytes, at most " +
                                      std::to_string(kLongest) + " are read: split the file into several files");
  std::string xml(static_cast<std::size_t>(bytes), '\0');
  pages.copy(offset, xml.size(), xml.data());
  return xml;
}

std::vector<E57Coordinates> findCoordinates(const E57Pages& pages, const E57Description& description) {
  std::vector<E57Coordinates> coordinates;
  for (std::size_t i = 0; i < description.scans.size(); ++i) {
    const std::optional<E57Coordinates> found = coordinatesOf(description.scans[i]);
    if (!found && description.scans[i].points > 0)
      throw FileError(pages.path(), e57Place(i) +
                                        "the points have neither cartesianX, cartesianY and cartesianZ nor "
                                        "sphericalRange, sphericalAzimuth and sphericalElevation");
    coordinates.push_back(found.value_or(E57Coordinates()));
  }
  return coordinates;
}

class E57File : public ScanFile {
 public:
  explicit E57File(const std::filesystem::path& path) {
    auto contents = std::make_shared<E57Contents>(path);
    contents->description = parseE57Xml(path, readXml(contents->pages));
    contents->sections = findE57Sections(contents->pages, contents->description);
    contents->coordinates = findCoordinates(contents->pages, contents->description);
    contents->pages.requireWhole();
    contents_ = std::move(contents);
    for (const E57Scan& scan : scans()) with_pose_ += scan.pose.has_value();
  }

  std::string kind() const override {
    const E57Header& header = contents_->pages.header();
    return "E57 " + std::to_string(header.major_version) + "." + std::to_string(header.minor_version);
  }
  std::size_t size() const override { return scans().size(); }
  FileScanInfo info(std::size_t scan) const override {
    const E57Scan& described = scans()[scan];
    FileScanInfo info;
    if (size() > 1) {
      info.name = "scan " + std::to_string(scan);
      if (!described.name.empty()) info.name += " (" + described.name + ")";
    }
    info.points = static_cast<std::size_t>(described.points);
    info.pose = described.pose;
    if (!info.pose && with_pose_ > 0) info.pose = Pose();
    info.time = described.time;
    return info;
  }
  std::unique_ptr<ScanReader> open(std::size_t scan) const override {
    return std::make_unique<E57ScanReader>(contents_, scan);
  }
  std::string poseSource() const override { return with_pose_ > 0 ? "E57 pose of each scan" : ""; }
  bool inMapFrame() const override { return with_pose_ == 0; }  // by the standard
  void releasePages() const override { contents_->pages.release(); }
  std::string coordinateSystem() const override { return contents_->description.coordinate_system; }
  std::vector<std::string> warnings() const override;

 private:
  const std::vector<E57Scan>& scans() const { return contents_->description.scans; }

  std::shared_ptr<const E57Contents> contents_;
  std::size_t with_pose_ = 0;  // number of scans
};

std::vector<std::string> E57File::warnings() const {
  std::vector<std::string> warnings;
  if (const std::uint64_t bytes = contents_->pages.trailingBytes(); bytes > 0)
    warnings.push_back(std::to_string(bytes) + " bytes after the last page are ignored");
  if (scans().empty())
    warnings.push_back("the file has no scans, only " + std::to_string(contents_->description.images) + " images");
  if (with_pose_ > 0 && with_pose_ < size()) {
    const auto without = std::find_if(scans().begin(), scans().end(), [](const E57Scan& scan) { return !scan.pose; });
    warnings.push_back(std::to_string(size() - with_pose_) + " of " + std::to_string(size()) +
                       " scans have no pose (the first is scan " + std::to_string(without - scans().begin()) +
                       "); their points are taken to be in the frame of the map, as the E57 standard says");
  }
  return warnings;
}

}  // namespace

bool isE57(std::string_view start) {
  constexpr std::string_view kSignature = "ASTM-E57";
  return start.substr(0, kSignature.size()) == kSignature;
}

std::unique_ptr<ScanFile> openE57(const std::filesystem::path& path) {
  return std::make_unique<E57File>(path);
}

}  // namespace gaussmap::detail
