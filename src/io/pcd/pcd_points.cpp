// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_points.h"

#include <cstring>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {

void readPoints(const PcdReader& reader, const std::vector<PcdOutput>& fields, const std::string& what,
                const std::function<void(std::size_t)>& body) {
  std::vector<std::size_t> offsets;
  for (const PcdOutput& wanted : fields) {
    const PcdField* const field = reader.header().find(wanted.name);
    if (!field || field->type != wanted.type || field->size != wanted.size || field->count != wanted.count)
      throw FileError(reader.path(),
                      "is not a " + what + ": field '" + wanted.name + "' is missing or has another type");
    offsets.push_back(field->offset);
  }
  const std::vector<char> bytes = reader.records();
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const char* const point = bytes.data() + i * reader.header().record_size;
    for (std::size_t k = 0; k < fields.size(); ++k)
      std::memcpy(const_cast<void*>(fields[k].data), point + offsets[k], fields[k].size * fields[k].count);
    body(i);
  }
}

}  // namespace gaussmap::detail
