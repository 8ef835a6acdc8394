// SPDX-License-Identifier: BSD-3-Clause
// Raw records of floats: the fields are guessed, given by the first line of the input, or fixed.
#include <algorithm>
#include <stdexcept>
#include <string>

#include "fuzz_scan_file.h"
#include "io/text/float_records.h"

namespace {

void readRecords(const std::filesystem::path& path, const std::string& fields) {
  using namespace gaussmap;
  fuzz::refusesOrReads([&] { fuzz::readScans(*detail::openFloatRecords(path, {fields})); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("scan.bin", data, size);
  readRecords(path, "");
  readRecords(path, "x y:f64 z:i16:cm ring:u8 -:u32 time:u32:us rgb r:i8 g:u16 b:i32");
  // The first line of the input is a list of fields.
  const std::uint8_t* const line_end = std::find(data, data + size, static_cast<std::uint8_t>('\n'));
  if (line_end == data + size) return 0;
  const std::string fields(reinterpret_cast<const char*>(data), static_cast<std::size_t>(line_end - data));
  const auto length = static_cast<std::size_t>(data + size - line_end - 1);
  try {
    readRecords(fuzz::asFile("scan.bin", line_end + 1, length), fields);
  } catch (const std::invalid_argument&) {
    // wrong fields
  }
  return 0;
}
