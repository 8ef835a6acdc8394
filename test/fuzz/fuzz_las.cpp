// SPDX-License-Identifier: BSD-3-Clause
// LAS files: the header, the coordinates, all values, the warnings.
#include "fuzz_scan_file.h"
#include "io/las/las_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("cloud.las", data, size);
  fuzz::refusesOrReads([&] { fuzz::readScans(*detail::openLas(path)); });
  return 0;
}
