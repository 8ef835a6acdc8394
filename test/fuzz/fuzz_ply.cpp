// SPDX-License-Identifier: BSD-3-Clause
// PLY meshes.
#include "fuzz_file.h"
#include "gaussmap/io/mesh/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("mesh.ply", data, size);
  fuzz::refusesOrReads([&] { checkMesh(readPly(path)); });
  return 0;
}
