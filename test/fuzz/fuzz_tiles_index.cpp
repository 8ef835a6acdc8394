// SPDX-License-Identifier: BSD-3-Clause
// The index of a directory of PCD tiles, in Autoware's format.
#include "fuzz_file.h"
#include "gaussmap/io/export/map_tiles.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("pointcloud_map_metadata.yaml", data, size);
  fuzz::refusesOrReads([&] { loadTiles(path.parent_path()); });
  return 0;
}
