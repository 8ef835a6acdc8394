// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <string>

#include "gaussmap/io/export/map_export.h"
#include "io/export/table_rows.h"
#include "io/files/write_buffer.h"

namespace gaussmap {
using namespace detail;

namespace {

template <typename Number>
void append(std::string& line, Number value) {
  char digits[32];
  if (!line.empty()) line += ',';
  line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace

std::size_t saveCsv(const std::filesystem::path& path, const GaussianMap<3>& map, std::optional<int> scale) {
  const std::vector<GaussianId> rows = tableRows(map, scale);
  AtomicFile file(path);
  WriteBuffer buffer(file);
  buffer.addText(
      "scale,cell_side,cell_x,cell_y,cell_z,x,y,z,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz,weight,log_odds\n");
  for (const GaussianId& id : rows) {
    const Gaussian<3> gaussian = map.gaussian(id.index, id.scale);
    std::string line;
    append(line, id.scale);
    append(line, map.grid().side(id.scale));
    for (const std::int32_t index : map.scale(id.scale).keys[map.cellOf(id.index, id.scale)]) append(line, index);
    for (int axis = 0; axis < 3; ++axis) append(line, gaussian.mean(axis));
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column) append(line, gaussian.cov(row, column));
    append(line, gaussian.weight);
    append(line, map.logOdds(id.index, id.scale));
    buffer.addText(line + "\n");
  }
  buffer.flush();
  file.commit();
  return rows.size();
}

}  // namespace gaussmap
