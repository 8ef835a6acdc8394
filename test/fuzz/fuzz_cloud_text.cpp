// SPDX-License-Identifier: BSD-3-Clause
// Text clouds (xyz, csv, pts, ptx): recognising, all scans, coordinates and values, with and without names of columns.
#include <cstdlib>
#include <string_view>

#include "fuzz_file.h"
#include "io/text/cloud_text.h"
#include "io/text/point_fields.h"

namespace {

void readScans(const gaussmap::detail::ScanFile& file) {
  using namespace gaussmap;
  constexpr std::size_t kMostScans = 8;
  for (std::size_t scan = 0; scan < file.size() && scan < kMostScans; ++scan) {
    const auto reader = file.open(scan);
    if (file.info(scan).points != reader->size()) std::abort();
    fuzz::refusesOrReads([&] {
      PointBlock<3> block;
      std::size_t count = 0;
      for (std::size_t first = 0; first < reader->size(); first += block.size) {
        reader->read(first, block);
        count += block.size;
        if (block.size == 0) std::abort();
      }
      if (count != reader->size()) std::abort();
      reader->read(reader->size() / 2, block);
    });
    std::size_t left = 8;
    for (const std::string& name : reader->valueNames()) {
      if (left-- == 0) break;
      fuzz::refusesOrReads([&] {
        if (reader->values(name).size() != reader->size()) std::abort();
      });
    }
    if (const auto pose = file.info(scan).pose; pose && !poseFault(*pose).empty()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("scan.txt", data, size);
  detail::isCloudText(std::string_view(reinterpret_cast<const char*>(data), size));
  fuzz::refusesOrReads([&] {
    const auto file = detail::openCloudText(path);
    file->kind();
    file->warnings();
    readScans(*file);
  });
  fuzz::refusesOrReads([&] { readScans(*detail::openCloudText(path, {"- x:mm y z time:ns r g b"})); });
  return 0;
}
