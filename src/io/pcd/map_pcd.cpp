// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/pcd/map_pcd.h"

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <system_error>

#include "gaussmap/core/error.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap {
namespace {

std::int32_t asIndex(double value) {
  if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value))
    throw std::invalid_argument("a cell key is not a whole number");
  return static_cast<std::int32_t>(value);
}

/// Returns the origin that the means are relative to. Throws if the VIEWPOINT also rotates, because cells of a map
/// cannot be rotated.
Eigen::Vector3d originOf(const PcdHeader& header) {
  Eigen::Vector3d origin = header.viewpoint.translation;
  if (!origin.allFinite() || !(header.viewpoint.rotation.vec().norm() == 0.0))
    throw std::invalid_argument("its VIEWPOINT is not a pure translation");
  return origin;
}

}  // namespace

void saveRecordsPcd(const std::filesystem::path& path, const GaussianRecords& all) {
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

void savePcd(const std::filesystem::path& path, const GaussianMap<3>& map, const ExportOptions& options) {
  std::error_code error;
  if (!options.overwrite && std::filesystem::exists(path, error))
    throw FileError(path, "exists already and is not overwritten");
  saveRecordsPcd(path, toRecords(map, options.scale));
}

GaussianRecords loadRecordsPcd(const std::filesystem::path& path) {
  const PcdReader reader(path);
  if (reader.header().find("covariance") == nullptr)
    throw FileError(path, "holds points, not Gaussians: it has no field 'covariance'");
  std::vector<PcdColumn> wanted = {{"x"},         {"y"},     {"z"},      {"weight"}, {"occupancy"},
                                   {"cell_side"}, {"scale"}, {"cell_x"}, {"cell_y"}, {"cell_z"}};
  for (std::size_t element = 0; element < 6; ++element) wanted.push_back({"covariance", element});
  const std::vector<std::vector<double>> columns = reader.columns(wanted);
  try {
    GaussianRecords all{{}, originOf(reader.header())};
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
    return all;
  } catch (const std::logic_error& error) {
    throw FileError(path, std::string("is not a map: ") + error.what());
  }
}

GaussianMap<3> loadPcd(const std::filesystem::path& path) {
  const GaussianRecords all = loadRecordsPcd(path);
  try {
    return fromRecords(all);
  } catch (const std::logic_error& error) {
    throw FileError(path, std::string("is not a map: ") + error.what());
  }
}

bool isGmap(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  const std::string start = "SQLite format 3";
  std::string head(start.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == start;
}

bool isMap(const std::filesystem::path& path) {
  if (isGmap(path)) return true;
  try {
    return PcdReader(path).header().find("covariance") != nullptr;
  } catch (const FileError&) {
    return false;
  }
}

GaussianMap<3> loadAny(const std::filesystem::path& path, MapMetadata* metadata) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw FileError(path, "does not exist");
  if (!isGmap(path) && (path.extension() != ".gmap" || isMap(path))) return loadPcd(path);
  GaussianMap<3> map = load(path);
  if (metadata != nullptr) *metadata = loadMetadata(path);
  return map;
}

}  // namespace gaussmap
