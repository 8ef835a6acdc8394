// SPDX-License-Identifier: BSD-3-Clause
// Pose files (TUM, KITTI), and the assignment of their poses to scans.
#include "fuzz_file.h"
#include "gaussmap/io/scans/pose_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("poses.txt", data, size);
  fuzz::refusesOrReads([&] {
    const PoseFile file = readPoseFile(path);
    for (const PoseFile::Entry& entry : file.entries)
      if (!poseFault(entry.pose).empty()) std::abort();
    posesForScans(file, {"000000.pcd", "000001.pcd", "000002.pcd"});
  });
  return 0;
}
