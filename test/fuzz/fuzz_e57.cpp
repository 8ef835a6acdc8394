// SPDX-License-Identifier: BSD-3-Clause
// E57 files as they are. The checksums stop most mutations, see fuzz_e57_packets.cpp.
#include "fuzz_e57.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gaussmap::fuzz::readE57(gaussmap::fuzz::asFile("scan.e57", data, size));
  return 0;
}
