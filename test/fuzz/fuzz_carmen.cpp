// SPDX-License-Identifier: BSD-3-Clause
// CARMEN logs, plain and gzip, as sweeps and as files of scans.
#include "fuzz_file.h"
#include "fuzz_scan_file.h"
#include "gaussmap/io/logs/carmen_log.h"
#include "io/logs/carmen_scans.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("robot.log", data, size);
  fuzz::refusesOrReads([&] {
    for (const LaserScan& scan : readCarmenLog(path).scans) scan.returned(0);
  });
  fuzz::refusesOrReads([&] { fuzz::readScans(*detail::openCarmenScans(path)); });
  return 0;
}
