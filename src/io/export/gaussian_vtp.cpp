// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/ellipsoid_pose.h"
#include "gaussmap/io/export/map_export.h"
#include "io/export/table_rows.h"
#include "io/files/write_buffer.h"

namespace gaussmap {
using namespace detail;

namespace {

enum class Type { Int32, Int64, Float32, Float64 };

std::string nameOf(Type type) {
  const char* const names[] = {"Int32", "Int64", "Float32", "Float64"};
  return names[static_cast<int>(type)];
}

std::size_t bytesOf(Type type) {
  return type == Type::Int32 || type == Type::Float32 ? 4 : 8;
}

/// One array of the file.
struct Array {
  const char* section;  // XML element that contains the array
  const char* name;
  Type type;
  std::size_t components;
  std::function<void(std::size_t row)> write;  // writes the numbers of one row

  std::uint64_t bytes(std::size_t rows) const { return rows * components * bytesOf(type); }
};

std::string xmlPart(const std::vector<Array>& arrays, std::size_t rows) {
  const std::string count = std::to_string(rows);
  std::string xml =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "  <PolyData>\n    <Piece NumberOfPoints=\"" +
      count + "\" NumberOfVerts=\"" + count + "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  std::uint64_t offset = 0;
  for (const char* const section : {"Points", "Verts", "PointData"}) {
    const bool is_data = section == std::string("PointData");
    xml += std::string("      <") + section +
           (is_data ? " Scalars=\"weight\" Normals=\"normal\" Tensors=\"deviation\">\n" : ">\n");
    for (const Array& array : arrays) {
      if (section != std::string(array.section)) continue;
      xml += "        <DataArray type=\"" + nameOf(array.type) + "\" Name=\"" + array.name +
             "\" NumberOfComponents=\"" + std::to_string(array.components) + "\" format=\"appended\" offset=\"" +
             std::to_string(offset) + "\"/>\n";
      offset += sizeof(std::uint64_t) + array.bytes(rows);  // each array begins with its length
    }
    xml += std::string("      </") + section + ">\n";
  }
  return xml + "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";
}

void addDoubles(WriteBuffer& buffer, const Vector<3>& vector) {
  for (int axis = 0; axis < 3; ++axis) buffer.add(vector(axis));
}

void addDoubles(WriteBuffer& buffer, const Matrix<3>& tensor) {
  for (int row = 0; row < 3; ++row) addDoubles(buffer, Vector<3>(tensor.row(row)));
}

Matrix<3> rootOf(const EllipsoidPose& pose) {
  const Matrix<3> turn = pose.rotation.toRotationMatrix();
  return turn * pose.deviations.asDiagonal() * turn.transpose();
}

/// Returns the row of each Gaussian's parent, or -1 if the parent is not in the file.
std::vector<std::int64_t> parentRows(const GaussianMap<3>& map, const std::vector<GaussianId>& rows, bool all_scales) {
  std::vector<std::int64_t> parents(rows.size(), -1);
  if (!all_scales) return parents;
  std::vector<std::size_t> first(static_cast<std::size_t>(map.scales()), 0);  // row of each scale's first Gaussian
  for (std::size_t row = rows.size(); row-- > 0;) first[static_cast<std::size_t>(rows[row].scale)] = row;
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (const auto [s, index] = rows[row]; s + 1 < map.scales())
      parents[row] = static_cast<std::int64_t>(first[static_cast<std::size_t>(s) + 1] + map.parentOf(index, s));
  return parents;
}

}  // namespace

std::size_t saveVtp(const std::filesystem::path& path, const GaussianMap<3>& map, std::optional<int> scale) {
  const std::vector<GaussianId> rows = tableRows(map, scale);
  const std::vector<std::int64_t> parents = parentRows(map, rows, !scale);
  const auto gaussian = [&](std::size_t row) { return map.gaussian(rows[row].index, rows[row].scale); };
  const auto log_odds = [&](std::size_t row) { return map.logOdds(rows[row].index, rows[row].scale); };

  AtomicFile file(path);
  WriteBuffer buffer(file);
  const std::vector<Array> arrays = {
      {"Points", "Points", Type::Float64, 3, [&](std::size_t row) { addDoubles(buffer, gaussian(row).mean); }},
      {"Verts", "connectivity", Type::Int64, 1, [&](std::size_t row) { buffer.add(static_cast<std::int64_t>(row)); }},
      {"Verts", "offsets", Type::Int64, 1, [&](std::size_t row) { buffer.add(static_cast<std::int64_t>(row + 1)); }},
      {"PointData", "covariance", Type::Float64, 9, [&](std::size_t row) { addDoubles(buffer, gaussian(row).cov); }},
      {"PointData", "deviation", Type::Float64, 9,
       [&](std::size_t row) { addDoubles(buffer, rootOf(ellipsoidPose(gaussian(row)))); }},
      {"PointData", "normal", Type::Float64, 3,
       [&](std::size_t row) { addDoubles(buffer, ellipsoidPose(gaussian(row)).normal()); }},
      {"PointData", "weight", Type::Float64, 1, [&](std::size_t row) { buffer.add(gaussian(row).weight); }},
      {"PointData", "log_odds", Type::Float32, 1, [&](std::size_t row) { buffer.add(log_odds(row)); }},
      {"PointData", "occupancy", Type::Float32, 1,
       [&](std::size_t row) { buffer.add(1.0f / (1.0f + std::exp(-log_odds(row)))); }},
      {"PointData", "scale", Type::Int32, 1,
       [&](std::size_t row) { buffer.add(static_cast<std::int32_t>(rows[row].scale)); }},
      {"PointData", "cell_side", Type::Float64, 1,
       [&](std::size_t row) { buffer.add(map.grid().side(rows[row].scale)); }},
      {"PointData", "parent", Type::Int64, 1, [&](std::size_t row) { buffer.add(parents[row]); }},
  };
  buffer.addText(xmlPart(arrays, rows.size()));
  for (const Array& array : arrays) {
    buffer.add(array.bytes(rows.size()));
    for (std::size_t row = 0; row < rows.size(); ++row) array.write(row);
  }
  buffer.addText("\n  </AppendedData>\n</VTKFile>\n");
  buffer.flush();
  file.commit();
  return rows.size();
}

}  // namespace gaussmap
