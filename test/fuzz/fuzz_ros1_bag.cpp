// SPDX-License-Identifier: BSD-3-Clause
// Bags of ROS 1.
#include "fuzz_recording.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  fuzz::readRecording(fuzz::asFile("a.bag", data, size));
  return 0;
}
