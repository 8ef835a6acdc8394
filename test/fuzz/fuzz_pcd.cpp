// SPDX-License-Identifier: BSD-3-Clause
// PCD files: the coordinates, the columns, whole records, the fingerprint.
#include "fuzz_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaussmap;
  const auto path = fuzz::asFile("scan.pcd", data, size);
  fuzz::refusesOrReads([&] {
    const PcdReader reader(path);
    reader.fingerprint();
    PointBlock<3> block;
    std::size_t count = 0;
    for (std::size_t first = 0; first < reader.size(); first += block.size) {
      reader.read(first, block);
      count += block.size;
      if (block.size == 0) std::abort();
    }
    if (count != reader.size()) std::abort();
  });
  fuzz::refusesOrReads([&] {
    const PcdReader reader(path);
    if (reader.records().size() != reader.size() * reader.header().record_size) std::abort();
  });
  fuzz::refusesOrReads([&] {
    const PcdReader reader(path);
    std::vector<PcdColumn> wanted;
    for (const PcdField& field : reader.header().fields)
      if (field.name != "_" && wanted.size() < 8) wanted.push_back({field.name, field.count - 1});
    for (const std::vector<double>& column : reader.columns(wanted))
      if (column.size() != reader.size()) std::abort();
  });
  return 0;
}
