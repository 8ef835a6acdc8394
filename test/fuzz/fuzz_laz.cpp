// SPDX-License-Identifier: BSD-3-Clause
// LAZ and COPC files: the header, the table of chunks, the coordinates, all values, the warnings.
#include "fuzz_file.h"
#include "io/laz/laz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.laz", data, size);
  fuzz::refusesOrReads([&] {
    const auto file = detail::openLaz(path);
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
    std::size_t values = 0;  // extra bytes can have hundreds of names, and each one decodes the file again
    for (const std::string& name : reader->valueNames())
      if (++values < 20 && count < 100000 && reader->values(name).size() != count) std::abort();
  });
  fuzz::refusesOrReads([&] {
    const auto source = detail::openLazSource(path);
    std::uint64_t count = 0;
    detail::decodeLaz(*source, detail::kAllLazLayers, [&](const char*, std::size_t group) { count += group; });
    if (count != source->header.points) std::abort();
  });
  return 0;
}
