// SPDX-License-Identifier: BSD-3-Clause
// Pose files of every kind, extrinsics, and the assignment of poses to scans.
#include "fuzz_file.h"
#include "gaussmap/io/scans/file_scans.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("poses.txt", data, size);
  fuzz::refusesOrReads([&] {
    const PoseFile file = readPoseFile(path);
    for (const PoseFile::Entry& entry : file.entries)
      if (entry.pose && !poseFault(*entry.pose).empty()) std::abort();
    for (const bool interpolate : {false, true}) {
      PoseMatching options;
      options.interpolate = interpolate;
      fuzz::refusesOrReads([&] { matchPoses(file, {{"000000.pcd", {}}, {"000001.pcd", {}}}, options); });
      fuzz::refusesOrReads([&] { matchPoses(file, {{"1689000000.5.pcd", {}}, {"1689000001.5.pcd", {}}}, options); });
    }
    posesForScans(file, {"000000.pcd", "000001.pcd", "000002.pcd"});
  });
  for (const PoseFormat format : {PoseFormat::Tum, PoseFormat::Kitti, PoseFormat::Matrix4, PoseFormat::EuRoc,
                                  PoseFormat::XyzRpyDegrees, PoseFormat::G2o, PoseFormat::Table})
    fuzz::refusesOrReads([&] { readPoseFile(path, format); });
  fuzz::refusesOrReads([&] { readExtrinsic(path); });
  return 0;
}
