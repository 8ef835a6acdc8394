// SPDX-License-Identifier: BSD-3-Clause
// PCD files that hold a map of Gaussians or a map of line segments.
#include "fuzz_file.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/pcd/map_pcd.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("map.pcd", data, size);
  fuzz::refusesOrReads([&] { loadPcd(path); });
  fuzz::refusesOrReads([&] { loadSegmentsPcd(path); });
  return 0;
}
