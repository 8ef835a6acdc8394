// SPDX-License-Identifier: BSD-3-Clause
// Map files: the whole map, a box, the metadata, the sizes.
#include "fuzz_file.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/gmap/map_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("map.gmap", data, size);
  fuzz::refusesOrReads([&] { load(path); });
  fuzz::refusesOrReads([&] { loadMetadata(path); });
  fuzz::refusesOrReads([&] { mapFileSize(path); });
  fuzz::refusesOrReads([&] {
    MapReader<3> reader(path);
    reader.load({Vector<3>::Constant(-5.0), Vector<3>::Constant(5.0)});
  });
  return 0;
}
