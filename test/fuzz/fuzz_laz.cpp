// SPDX-License-Identifier: BSD-3-Clause
// LAZ and COPC files: the header, the table of chunks, the coordinates, some of the values, the warnings.
#include "fuzz_scan_file.h"
#include "io/laz/laz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.laz", data, size);
  fuzz::refusesOrReads([&] { fuzz::readScans(*detail::openLaz(path)); });
  fuzz::refusesOrReads([&] {
    const auto source = detail::openLazSource(path);
    std::uint64_t count = 0;
    detail::decodeLaz(*source, detail::kAllLazLayers, [&](const char*, std::size_t group) { count += group; });
    if (count != source->header.points) std::abort();
  });
  return 0;
}
