// SPDX-License-Identifier: BSD-3-Clause
// E57 files whose header and checksums are always right. The input is the section of points, which starts at byte 48 of
// the file, followed by the XML section, which starts with "<?xml".
#include <algorithm>
#include <cstdint>
#include <string>

#include "fuzz_e57.h"
#include "io/e57/crc32c.h"

namespace {

constexpr std::size_t kPage = 1024, kData = 1020;

void append(std::string& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i));
}

std::string fileOf(const std::string& input) {
  constexpr std::size_t kHeader = 48;
  const std::size_t split = std::min(input.find("<?xml"), input.size());
  const std::uint64_t pages = (kHeader + input.size() + kData - 1) / kData, xml = kHeader + split;
  std::string logical = "ASTM-E57";
  append(logical, 1, 4);
  append(logical, 0, 4);
  append(logical, pages * kPage, 8);
  append(logical, xml / kData * kPage + xml % kData, 8);
  append(logical, input.size() - split, 8);
  append(logical, kPage, 8);
  logical += input;
  logical.resize(pages * kData, '\0');
  std::string file;
  for (std::size_t first = 0; first < logical.size(); first += kData) {
    const std::string page = logical.substr(first, kData);
    file += page;
    append(file, __builtin_bswap32(gaussmap::detail::crc32c(page)), 4);
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file = fileOf(std::string(reinterpret_cast<const char*>(data), size));
  gaussmap::fuzz::readE57(
      gaussmap::fuzz::asFile("scan.e57", reinterpret_cast<const std::uint8_t*>(file.data()), file.size()));
  return 0;
}
