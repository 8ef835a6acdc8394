// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_scans.h"

#include <utility>
#include <vector>

#include "io/messages/bag_content.h"
#include "io/messages/bag_poses.h"
#include "io/messages/message_scans.h"

namespace gaussmap::detail {
namespace {

class OpenBagScans : public ScanFile {
 public:
  OpenBagScans(std::unique_ptr<MessageFile> file, std::filesystem::path path, BagContent content,
               AssignedBagPoses assigned, bool mounted)
      : file_(std::move(file)),
        path_(std::move(path)),
        topic_(std::move(content.scan_topic)),
        scans_(std::move(content.scans)),
        assigned_(std::move(assigned)),
        mounted_(mounted),
        warnings_(file_->warnings()) {
    warnings_.insert(warnings_.end(), content.warnings.begin(), content.warnings.end());
    warnings_.insert(warnings_.end(), assigned_.warnings.begin(), assigned_.warnings.end());
  }

  std::string kind() const override { return file_->kind() + ", " + topic_.type; }
  std::size_t size() const override { return scans_.size(); }
  FileScanInfo info(std::size_t scan) const override {
    const BagScan& one = scans_.at(scan);
    FileScanInfo info{topic_.name + " " + stampText(one.time), one.points, std::nullopt, one.time};
    (mounted_ ? info.sensor_in_pose_frame : info.pose) = assigned_.poses.at(scan);
    return info;
  }
  std::unique_ptr<ScanReader> open(std::size_t scan) const override {
    const MessagePlace& place = scans_.at(scan).place;
    return readScan(topic_.type, file_->read(place), file_->topics()[place.topic].encoding,
                    originOf(path_, *file_, place));
  }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::string poseSource() const override { return assigned_.source; }
  MissingPoses missingPoses() const override { return assigned_.missing; }
  std::string mapFrame() const override { return assigned_.map_frame; }
  bool inMapFrame() const override { return assigned_.in_fixed_frame; }

 private:
  std::unique_ptr<MessageFile> file_;
  std::filesystem::path path_;
  TopicGroup topic_;
  std::vector<BagScan> scans_;
  AssignedBagPoses assigned_;
  bool mounted_;  // true: assigned_.poses are mountings
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<ScanFile> openBagScans(std::unique_ptr<MessageFile> file, const std::filesystem::path& path,
                                       const BagOptions& options) {
  BagContent content = readBagContent(*file, path, options);
  AssignedBagPoses assigned = assignBagPoses(path, content, options);
  return std::make_unique<OpenBagScans>(std::move(file), path, std::move(content), std::move(assigned),
                                        options.poses == BagPoses::None);
}

}  // namespace gaussmap::detail
