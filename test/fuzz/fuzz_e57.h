// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "fuzz_file.h"
#include "io/e57/e57_file.h"

namespace gaussmap::fuzz {

/// Reads all points and values of a file. A scan that is refused does not end the reading.
inline void readE57(const std::filesystem::path& path) {
  std::unique_ptr<detail::ScanFile> file;
  refusesOrReads([&] {
    file = detail::openE57(path);
    file->kind();
    file->warnings();
    file->coordinateSystem();
  });
  for (std::size_t scan = 0; file && scan < file->size(); ++scan) {
    const detail::FileScanInfo info = file->info(scan);
    const std::unique_ptr<ScanReader> reader = file->open(scan);
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
    });
    std::size_t left = 16;  // more values only take time
    for (const std::string& name : reader->valueNames()) {
      if (left-- == 0) break;
      refusesOrReads([&] {
        if (reader->values(name).size() != reader->size()) std::abort();
      });
    }
  }
}

}  // namespace gaussmap::fuzz
