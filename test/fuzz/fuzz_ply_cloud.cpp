// SPDX-License-Identifier: BSD-3-Clause
// PLY clouds: the header, the coordinates, some of the values, the warnings.
#include "fuzz_scan_file.h"
#include "io/ply/ply_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.ply", data, size);
  fuzz::refusesOrReads([&] { fuzz::readScans(*detail::openPlyCloud(path)); });
  return 0;
}
