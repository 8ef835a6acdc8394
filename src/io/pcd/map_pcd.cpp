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
#include "io/files/text.h"
#include "io/pcd/wide_records.h"
#include "map/in_space.h"

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

/// Writes records whose means relative to `origin` have the type Real.
template <typename Real>
void writeRecords(const std::filesystem::path& path, const GaussianRecords& all, const Eigen::Vector3d& origin) {
  const GaussianRecord empty{};
  const GaussianRecord& first = all.records.empty() ? empty : all.records.front();
  constexpr std::size_t kStride = sizeof(GaussianRecord);
  const Eigen::Vector3d shift = all.origin - origin;
  std::vector<std::array<Real, 3>> means;
  means.reserve(all.records.size() + 1);
  for (const GaussianRecord& record : all.records)
    means.push_back({static_cast<Real>(record.mean[0] + shift.x()), static_cast<Real>(record.mean[1] + shift.y()),
                     static_cast<Real>(record.mean[2] + shift.z())});
  if (means.empty()) means.emplace_back();
  Pose viewpoint;
  viewpoint.translation = origin;
  writePcd(
      path, all.records.size(),
      {pcdOutput("x", &means.front()[0], 1, sizeof(means.front())),
       pcdOutput("y", &means.front()[1], 1, sizeof(means.front())),
       pcdOutput("z", &means.front()[2], 1, sizeof(means.front())),
       pcdOutput("covariance", first.covariance.data(), 6, kStride), pcdOutput("weight", &first.weight, 1, kStride),
       pcdOutput("occupancy", &first.occupancy, 1, kStride), pcdOutput("cell_side", &first.cell_side, 1, kStride),
       pcdOutput("scale", &first.scale, 1, kStride), pcdOutput("cell_x", &first.cell[0], 1, kStride),
       pcdOutput("cell_y", &first.cell[1], 1, kStride), pcdOutput("cell_z", &first.cell[2], 1, kStride)},
      viewpoint);
}

}  // namespace

void saveRecordsPcd(const std::filesystem::path& path, const GaussianRecords& all) {
  writeRecords<float>(path, all, all.origin);
}

void detail::saveWideRecordsPcd(const std::filesystem::path& path, const GaussianRecords& all) {
  writeRecords<double>(path, all, Eigen::Vector3d::Zero());
}

void savePcd(const std::filesystem::path& path, const GaussianMap<3>& map, const ExportOptions& options) {
  std::error_code error;
  if (!options.overwrite && std::filesystem::exists(path, error))
    throw FileError(path, "exists already and is not overwritten");
  saveRecordsPcd(path, toRecords(map, options.scale));
}

void savePcd(const std::filesystem::path& path, const GaussianMap<2>& map, const ExportOptions& options) {
  savePcd(path, detail::inSpace(map), options);
}

GaussianRecords loadRecordsPcd(const std::filesystem::path& path) {
  const PcdReader reader(path);
  if (reader.header().find("covariance") == nullptr)
    throw FileError(
        path, "holds points, not Gaussians: it has no field 'covariance'; build a map from it with gaussmap pcd2map");
  std::vector<PcdColumn> wanted = {{"x"},         {"y"},     {"z"},      {"weight"}, {"occupancy"},
                                   {"cell_side"}, {"scale"}, {"cell_x"}, {"cell_y"}, {"cell_z"}};
  for (std::size_t element = 0; element < 6; ++element) wanted.push_back({"covariance", element});
  const std::vector<std::vector<double>> columns = reader.columns(wanted);
  try {
    GaussianRecords all{{}, originOf(reader.header())};
    for (std::size_t i = 0; i < reader.size(); ++i) {
      GaussianRecord record;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        record.mean[axis] = columns[axis][i];
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
  const std::string ending = detail::lowerCase(path.extension().string());
  if (!isGmap(path) && (ending != ".gmap" || isMap(path))) return loadPcd(path);
  GaussianMap<3> map = load(path);
  if (metadata != nullptr) *metadata = loadMetadata(path);
  return map;
}

}  // namespace gaussmap
