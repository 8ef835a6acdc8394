// SPDX-License-Identifier: BSD-3-Clause
// Text clouds (xyz, csv, pts, ptx): recognising, all scans, coordinates and values, with and without names of columns.
#include <string_view>

#include "fuzz_scan_file.h"
#include "io/text/cloud_text.h"

namespace {

void readText(const std::filesystem::path& path, const std::string& fields) {
  using namespace gaussmap;
  fuzz::refusesOrReads([&] {
    const auto file = detail::openCloudText(path, {fields});
    fuzz::readScans(*file);
    if (file->size() == 0) return;
    if (const auto pose = file->info(0).pose; pose && !poseFault(*pose).empty()) std::abort();
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto path = gaussmap::fuzz::asFile("scan.txt", data, size);
  gaussmap::detail::isCloudText(std::string_view(reinterpret_cast<const char*>(data), size));
  readText(path, "");
  readText(path, "- x:mm y z time:ns r g b");
  return 0;
}
