// SPDX-License-Identifier: BSD-3-Clause
// Times and numbers in the names of scans: one name per line.
#include <sstream>

#include "fuzz_file.h"
#include "io/scans/name_numbers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap::detail;
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> names;
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  const NameNumbers numbers = numbersIn(names);
  if (!numbers.times.empty() && numbers.times.size() != names.size()) std::abort();
  if (!numbers.indices.empty() && numbers.indices.size() != names.size()) std::abort();
  for (const Decimal& time : numbers.times)
    for (const TimeUnit unit : kTimeUnits) toTime(time, unit);
  return 0;
}
