// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A PCD file and the pose of its sensor.
struct PcdScan {
  std::filesystem::path path;
  Pose pose;                                  ///< unit quaternion
  std::optional<double> time = std::nullopt;  ///< [s]
};

/// PCD files as scans. Each file is opened once; the points of an ascii or compressed file are kept only while its
/// reader lives. The values of the points are the other numbers of the file, fields of several numbers by index:
/// "intensity", "normal[2]".
class GAUSSMAP_API PcdScans : public Scans {
 public:
  /// Opens the files and checks their headers, but for the first ones if they are open already. Throws FileError.
  explicit PcdScans(std::vector<PcdScan> scans, ScanFrame frame = ScanFrame::Sensor,
                    std::vector<PcdReader> opened = {});
  ~PcdScans() override;
  PcdScans(PcdScans&&) noexcept;
  PcdScans& operator=(PcdScans&&) noexcept;

  std::size_t size() const override { return scans_.size(); }
  ScanInfo info(std::size_t index) const override;
  ScanFrame frame() const override { return frame_; }
  std::unique_ptr<ScanReader> open(std::size_t index) const override;

  const std::vector<PcdScan>& files() const { return scans_; }
  /// A reader of the file, for what is not in the interface: header, records, columns.
  PcdReader reader(std::size_t index) const;

 private:
  std::vector<PcdScan> scans_;
  std::vector<PcdReader> opened_;  // of the first scans: a process can map so many files only
  ScanFrame frame_;
};

/// The files that a list of inputs means: files as they are, directories replaced by the *.pcd in them (in any case,
/// not recursively, no hidden files) in natural order. The order of the inputs stays. Throws FileError if an input does
/// not exist or a directory has no such file.
GAUSSMAP_API std::vector<std::filesystem::path> listScans(const std::vector<std::filesystem::path>& inputs);

/// Scans with poses, and what looks wrong with them.
struct FoundScans {
  PcdScans scans;
  std::vector<std::string> warnings;  ///< one sentence or two each, with file names and the way out
};

/// Lists the scans (listScans()), gives each its pose, and checks the poses. The pose of a scan is
/// its VIEWPOINT, unless `poses` names a pose file (readPoseFile(), posesForScans()). Warns of a scan that is given
/// twice. Throws FileError if a file cannot be read, is a map, or a pose is unusable.
GAUSSMAP_API FoundScans findScans(const std::vector<std::filesystem::path>& inputs,
                                  const std::filesystem::path& poses = {}, ScanFrame frame = ScanFrame::Sensor);

}  // namespace gaussmap
