// SPDX-License-Identifier: BSD-3-Clause
#include "io/export/diff_pcd.h"

#include <array>
#include <cstdint>
#include <vector>

#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::detail {
namespace {

/// One point of the file.
struct DiffRow {
  std::array<float, 3> mean;
  std::array<float, 6> covariance;
  float weight, p_value;
  std::uint32_t label;
};

DiffRow rowOf(const GaussianMap<3>& map, std::size_t index, int s, const Eigen::Vector3d& origin,
              const Difference& one) {
  const Gaussian<3> gaussian = map.gaussian(index, s);
  const Eigen::Vector3f mean = (gaussian.mean - origin).cast<float>();
  const Eigen::Matrix3f cov = gaussian.cov.cast<float>();
  return {{mean.x(), mean.y(), mean.z()},
          {cov(0, 0), cov(0, 1), cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2)},
          static_cast<float>(gaussian.weight),
          static_cast<float>(one.p_value),
          static_cast<std::uint32_t>(one.change)};
}

}  // namespace

void writeDiffPcd(const std::filesystem::path& path, const GaussianMap<3>& first, const GaussianMap<3>& second,
                  const MapDiff& diff, int scale) {
  const Eigen::Vector3d origin = toRecords(second, scale).origin;
  std::vector<DiffRow> rows;
  for (std::size_t i = 0; i < diff.second.size(); ++i) rows.push_back(rowOf(second, i, scale, origin, diff.second[i]));
  for (std::size_t i = 0; i < diff.first.size(); ++i)
    if (diff.first[i].change == Change::Gone) rows.push_back(rowOf(first, i, scale, origin, diff.first[i]));
  const DiffRow none{};
  const DiffRow& row = rows.empty() ? none : rows.front();
  const std::vector<PcdOutput> fields = {pcdOutput("x", &row.mean[0], 1, sizeof(DiffRow)),
                                         pcdOutput("y", &row.mean[1], 1, sizeof(DiffRow)),
                                         pcdOutput("z", &row.mean[2], 1, sizeof(DiffRow)),
                                         pcdOutput("covariance", row.covariance.data(), 6, sizeof(DiffRow)),
                                         pcdOutput("weight", &row.weight, 1, sizeof(DiffRow)),
                                         pcdOutput("p_value", &row.p_value, 1, sizeof(DiffRow)),
                                         pcdOutput("label", &row.label, 1, sizeof(DiffRow))};
  writePcd(path, rows.size(), fields, Pose{origin, Pose::Rotation::Identity()});
}

}  // namespace gaussmap::detail
