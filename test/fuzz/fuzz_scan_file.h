// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "fuzz_file.h"
#include "io/formats/scan_file.h"

namespace gaussmap::fuzz {

/// Reads what an open file says about itself, then all points and some values of up to 8 scans. A scan that is refused
/// does not end the reading. Aborts if a file contradicts itself.
inline void readScans(const detail::ScanFile& file) {
  constexpr std::size_t kMostScans = 8, kMostValues = 16, kMostPoints = 100000;  // more only take time
  file.kind();
  file.coordinateSystem();
  file.warnings();
  for (std::size_t scan = 0; scan < file.size() && scan < kMostScans; ++scan) {
    const detail::FileScanInfo info = file.info(scan);
    const std::unique_ptr<ScanReader> reader = file.open(scan);
    if (reader->size() != info.points) std::abort();
    refusesOrReads([&] {
      PointBlock<3> block;
      std::size_t count = 0;
      for (std::size_t first = 0; first < reader->size(); first += block.size) {
        reader->read(first, block);
        count += block.size;
        if (block.size == 0) std::abort();
      }
      if (count != reader->size()) std::abort();
      reader->read(count / 2, block);
    });
    std::size_t left = reader->size() < kMostPoints ? kMostValues : 0;
    for (const std::string& name : reader->valueNames()) {
      if (left == 0) break;
      --left;
      refusesOrReads([&] {
        if (reader->values(name).size() != reader->size()) std::abort();
      });
    }
  }
}

}  // namespace gaussmap::fuzz
