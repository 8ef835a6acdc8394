// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/map_pcd.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "gaussmap/io/error.h"
#include "gaussmap/io/map_file.h"
#include "gaussmap/io/pcd_reader.h"
#include "gaussmap/io/pcd_writer.h"

namespace gaussmap {
namespace {

std::int32_t asIndex(double value) {
  if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value))
    throw std::invalid_argument("a cell key that is no whole number");
  return static_cast<std::int32_t>(value);
}

/// What fits into the first block; nothing if the file cannot be read.
std::string firstBytes(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "";
  std::ifstream file(path, std::ios::binary);
  std::string head(4096, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

}  // namespace

void saveMapPcd(const GaussianMap<3>& map, const std::filesystem::path& path, const ExportOptions& options) {
  if (!options.overwrite && std::filesystem::exists(path)) throw FileError(path, "exists already and is kept");
  const GaussianRecords all = toRecords(map, options.scale);
  const GaussianRecord empty{};
  const GaussianRecord& first = all.records.empty() ? empty : all.records.front();
  constexpr std::size_t kStride = sizeof(GaussianRecord);
  Pose viewpoint;
  viewpoint.translation = all.origin;
  writePcd(path, all.records.size(),
           {pcdOutput("x", &first.mean[0], 1, kStride), pcdOutput("y", &first.mean[1], 1, kStride),
            pcdOutput("z", &first.mean[2], 1, kStride), pcdOutput("covariance", first.covariance.data(), 6, kStride),
            pcdOutput("weight", &first.weight, 1, kStride), pcdOutput("occupancy", &first.occupancy, 1, kStride),
            pcdOutput("cell_side", &first.cell_side, 1, kStride), pcdOutput("scale", &first.scale, 1, kStride),
            pcdOutput("cell_x", &first.cell[0], 1, kStride), pcdOutput("cell_y", &first.cell[1], 1, kStride),
            pcdOutput("cell_z", &first.cell[2], 1, kStride)},
           viewpoint);
}

GaussianMap<3> loadMapPcd(const std::filesystem::path& path) {
  const PcdReader reader(path);
  if (reader.header().find("covariance") == nullptr)
    throw FileError(path, "is a cloud of points, not of Gaussians: its fields lack 'covariance'");
  std::vector<PcdColumn> wanted = {{"x"}, {"y"}, {"z"}, {"weight"}, {"occupancy"}, {"cell_side"}, {"scale"}, {"cell_x"},
                                   {"cell_y"}, {"cell_z"}};
  for (std::size_t element = 0; element < 6; ++element) wanted.push_back({"covariance", element});
  const std::vector<std::vector<double>> columns = reader.columns(wanted);
  GaussianRecords all{{}, reader.header().viewpoint.translation};
  try {
    for (std::size_t i = 0; i < reader.size(); ++i) {
      GaussianRecord record;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        record.mean[axis] = static_cast<float>(columns[axis][i]);
        record.cell[axis] = asIndex(columns[7 + axis][i]);
      }
      for (std::size_t element = 0; element < 6; ++element)
        record.covariance[element] = static_cast<float>(columns[10 + element][i]);
      record.weight = static_cast<float>(columns[3][i]);
      record.occupancy = static_cast<float>(columns[4][i]);
      record.cell_side = static_cast<float>(columns[5][i]);
      record.scale = static_cast<float>(columns[6][i]);
      all.records.push_back(record);
    }
    return fromRecords(all);
  } catch (const std::invalid_argument& error) {
    throw FileError(path, std::string("is no map: ") + error.what());
  }
}

bool isGmap(const std::filesystem::path& path) { return firstBytes(path).compare(0, 15, "SQLite format 3") == 0; }

bool isMap(const std::filesystem::path& path) {
  if (isGmap(path)) return true;
  const std::string head = firstBytes(path);
  const std::size_t fields = head.find("\nFIELDS ");
  return fields != std::string::npos && head.find(" covariance ", fields) < head.find('\n', fields + 1);
}

GaussianMap<3> loadAnyMap(const std::filesystem::path& path, MapMetadata* metadata) {
  const std::string head = firstBytes(path);
  if (head.find("VERSION") == 0 || head.find("# .PCD") == 0) return loadMapPcd(path);
  GaussianMap<3> map = loadMap<3>(path);
  if (metadata != nullptr) *metadata = loadMetadata(path);
  return map;
}

}  // namespace gaussmap
