// SPDX-License-Identifier: BSD-3-Clause
// PLY clouds: the header, the coordinates, some of the values, the warnings.
#include <algorithm>

#include "fuzz_file.h"
#include "io/ply/ply_cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.ply", data, size);
  fuzz::refusesOrReads([&] {
    const auto file = detail::openPlyCloud(path);
    file->warnings();
    const auto reader = file->open(0);
    PointBlock<3> block;
    std::size_t count = 0;
    for (std::size_t first = 0; first < reader->size(); first += block.size) {
      reader->read(first, block);
      count += block.size;
      if (block.size == 0) std::abort();
    }
    if (count != reader->size() || count != file->info(0).points) std::abort();
    const std::vector<std::string> names = reader->valueNames();
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 8); ++i)
      if (reader->values(names[i]).size() != count) std::abort();
  });
  return 0;
}
