// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/removed_pcd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/in_space.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/pcd/pcd_points.h"

namespace gaussmap::detail {
namespace {

struct Record {
  std::array<double, 3> mean;
  std::array<double, 6> covariance;  // upper triangle by rows
  double weight, log_odds;
  std::int64_t count;
  std::array<std::int64_t, 3> sum;
  std::array<std::int64_t, 6> product;
  std::array<std::int32_t, 3> cell;
  std::uint32_t scale, hits, misses, first_hit, last_hit, deleted_after;
};

/// Returns every field of a record. It is used for writing and for reading.
std::vector<PcdOutput> fieldsOf(const Record& r) {
  constexpr std::size_t kStride = sizeof(Record);
  return {pcdOutput("x", &r.mean[0], 1, kStride),
          pcdOutput("y", &r.mean[1], 1, kStride),
          pcdOutput("z", &r.mean[2], 1, kStride),
          pcdOutput("covariance", r.covariance.data(), 6, kStride),
          pcdOutput("weight", &r.weight, 1, kStride),
          pcdOutput("scale", &r.scale, 1, kStride),
          pcdOutput("cell_x", &r.cell[0], 1, kStride),
          pcdOutput("cell_y", &r.cell[1], 1, kStride),
          pcdOutput("cell_z", &r.cell[2], 1, kStride),
          pcdOutput("log_odds", &r.log_odds, 1, kStride),
          pcdOutput("hits", &r.hits, 1, kStride),
          pcdOutput("misses", &r.misses, 1, kStride),
          pcdOutput("first_hit", &r.first_hit, 1, kStride),
          pcdOutput("last_hit", &r.last_hit, 1, kStride),
          pcdOutput("deleted_after", &r.deleted_after, 1, kStride),
          pcdOutput("count", &r.count, 1, kStride),
          pcdOutput("sum", r.sum.data(), 3, kStride),
          pcdOutput("product", r.product.data(), 6, kStride)};
}

Record toRecord(const RemovedCluster<3>& removed) {
  Record record{};
  std::size_t slot = 0;
  for (int row = 0; row < 3; ++row) {
    record.mean[std::size_t(row)] = removed.gaussian.mean[row];
    for (int column = row; column < 3; ++column) record.covariance[slot++] = removed.gaussian.cov(row, column);
  }
  record.weight = removed.gaussian.weight;
  record.log_odds = removed.log_odds;
  record.count = removed.moments.count;
  record.sum = removed.moments.sum;
  record.product = removed.moments.product;
  record.cell = removed.key;
  record.scale = static_cast<std::uint32_t>(removed.scale);
  record.hits = removed.evidence.hits;
  record.misses = removed.evidence.misses;
  record.first_hit = removed.evidence.first_hit;
  record.last_hit = removed.evidence.last_hit;
  record.deleted_after = removed.scan;
  return record;
}

RemovedCluster<3> fromRecord(const Record& record) {
  RemovedCluster<3> removed;
  std::size_t slot = 0;
  for (int row = 0; row < 3; ++row) {
    removed.gaussian.mean[row] = record.mean[std::size_t(row)];
    for (int column = row; column < 3; ++column)
      removed.gaussian.cov(row, column) = removed.gaussian.cov(column, row) = record.covariance[slot++];
  }
  removed.gaussian.weight = record.weight;
  removed.log_odds = record.log_odds;
  removed.moments.count = record.count;
  removed.moments.sum = record.sum;
  removed.moments.product = record.product;
  removed.key = record.cell;
  removed.scale = static_cast<int>(record.scale);
  removed.evidence = {record.hits, record.misses, record.first_hit, record.last_hit};
  removed.scan = record.deleted_after;
  return removed;
}

// The order of the products of CellMoments: xx xy yy in the plane, xx xy xz yy yz zz in space.
constexpr std::size_t kPlanarProducts[3] = {0, 1, 3};
constexpr std::int64_t kPlaneOffset = -kStepsPerCell / 2;  // the plane is the lower face of the cells at z = 0

Record toRecord(const RemovedCluster<2>& removed) {
  const double thickness = std::sqrt(std::max(0.0, principalAxes(removed.gaussian).variances[0]));
  RemovedCluster<3> in_space{removed.scale,
                             inSpace(removed.gaussian, thickness),
                             {removed.key[0], removed.key[1], 0},
                             {},
                             removed.log_odds,
                             removed.evidence,
                             removed.scan};
  const CellMoments<2>& flat = removed.moments;
  CellMoments<3>& moments = in_space.moments;
  moments.count = flat.count;
  moments.sum = {flat.sum[0], flat.sum[1], kPlaneOffset * flat.count};
  for (std::size_t i = 0; i < 3; ++i) moments.product[kPlanarProducts[i]] = flat.product[i];
  moments.product[2] = kPlaneOffset * flat.sum[0];
  moments.product[4] = kPlaneOffset * flat.sum[1];
  moments.product[5] = kPlaneOffset * kPlaneOffset * flat.count;
  return toRecord(in_space);
}

RemovedCluster<2> inPlane(const RemovedCluster<3>& removed) {
  RemovedCluster<2> flat{
      removed.scale,
      {removed.gaussian.mean.head<2>(), removed.gaussian.cov.topLeftCorner<2, 2>(), removed.gaussian.weight},
      {removed.key[0], removed.key[1]},
      {},
      removed.log_odds,
      removed.evidence,
      removed.scan};
  flat.moments.count = removed.moments.count;
  flat.moments.sum = {removed.moments.sum[0], removed.moments.sum[1]};
  for (std::size_t i = 0; i < 3; ++i) flat.moments.product[i] = removed.moments.product[kPlanarProducts[i]];
  return flat;
}

/// Returns true if points of a cell can have such moments. An offset has at most 15 bits and a sign, see CellMoments.
bool isPossible(const CellMoments<3>& moments) {
  constexpr std::int64_t kMaxOffset = kStepsPerCell / 2;
  if (moments.count < 0 || moments.count >= std::int64_t{1} << 33) return false;
  const auto isWithin = [](std::int64_t value, std::int64_t most) { return value >= -most && value <= most; };
  for (const std::int64_t sum : moments.sum)
    if (!isWithin(sum, moments.count * kMaxOffset)) return false;
  for (const std::int64_t product : moments.product)
    if (!isWithin(product, moments.count * (kMaxOffset * kMaxOffset))) return false;
  return moments.product[0] >= 0 && moments.product[3] >= 0 && moments.product[5] >= 0;
}

bool isUsable(const RemovedCluster<3>& removed) {
  return removed.gaussian.mean.allFinite() && removed.gaussian.cov.allFinite() && removed.gaussian.weight >= 0.0 &&
         std::isfinite(removed.gaussian.weight) && std::isfinite(removed.log_odds) && removed.scale >= 0 &&
         removed.scale < 64 && isPossible(removed.moments);
}

}  // namespace

template <int D>
void writeRemoved(const std::filesystem::path& path, const std::vector<RemovedCluster<D>>& removed) {
  std::vector<Record> records;
  records.reserve(removed.size());
  for (const RemovedCluster<D>& one : removed) records.push_back(toRecord(one));
  const Record none{};
  writePcd(path, records.size(), fieldsOf(records.empty() ? none : records.front()));
}

template <int D>
std::vector<RemovedCluster<D>> readRemoved(const std::filesystem::path& path) {
  const PcdReader reader(path);
  Record record{};
  std::vector<RemovedCluster<D>> removed;
  removed.reserve(reader.size());
  readPoints(reader, fieldsOf(record), "cloud of deleted clusters", [&](std::size_t i) {
    const RemovedCluster<3> cluster = fromRecord(record);
    const std::string name = "point " + std::to_string(i);
    if (!isUsable(cluster)) throw FileError(path, name + " is not a cluster: a value is impossible or not finite");
    if constexpr (D == 2) {
      if (cluster.gaussian.mean.z() != 0.0 || cluster.key[2] != 0)
        throw FileError(path, name + " does not lie in the plane z = 0: it was not deleted from a planar map");
      removed.push_back(inPlane(cluster));
    } else {
      removed.push_back(cluster);
    }
  });
  return removed;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                         \
  template void writeRemoved<D>(const std::filesystem::path&, const std::vector<RemovedCluster<(D)>>&); \
  template std::vector<RemovedCluster<(D)>> readRemoved<D>(const std::filesystem::path&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
