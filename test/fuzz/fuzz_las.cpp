// SPDX-License-Identifier: BSD-3-Clause
// LAS files: the header, the coordinates, all values, the warnings.
#include "fuzz_file.h"
#include "io/las/las_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.las", data, size);
  fuzz::refusesOrReads([&] {
    const auto file = detail::openLas(path);
    file->warnings();
    file->coordinateSystem();
    const auto reader = file->open(0);
    PointBlock<3> block;
    std::size_t count = 0;
    for (std::size_t first = 0; first < reader->size(); first += block.size) {
      reader->read(first, block);
      count += block.size;
      if (block.size == 0) std::abort();
    }
    if (count != reader->size() || count != file->info(0).points) std::abort();
    for (const std::string& name : reader->valueNames())
      if (reader->values(name).size() != count) std::abort();
  });
  return 0;
}
