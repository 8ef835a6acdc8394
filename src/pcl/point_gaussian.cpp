// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/point_gaussian.h"

#include <ostream>

namespace gaussmap {

std::ostream& operator<<(std::ostream& out, const PointGaussian& point) {
  out << '(' << point.x << ',' << point.y << ',' << point.z << " - covariance " << point.covariance[0];
  for (int element = 1; element < 6; ++element) out << ',' << point.covariance[element];
  return out << " - weight " << point.weight << ", occupancy " << point.occupancy << ", cell " << point.cell_x << ','
             << point.cell_y << ',' << point.cell_z << " of " << point.cell_side << " m, scale " << point.scale << ')';
}

void detail::transformGaussians(const Eigen::Matrix4d& transform, bool copy_all_fields,
                                pcl::PointCloud<PointGaussian>& cloud) {
  const Eigen::Matrix3d linear = transform.topLeftCorner<3, 3>();
  const Eigen::Vector3d offset = transform.topRightCorner<3, 1>();
  for (PointGaussian& point : cloud) {
    const auto& c = point.covariance;
    Eigen::Matrix3d covariance;
    covariance << double{c[0]}, double{c[1]}, double{c[2]}, double{c[1]}, double{c[3]}, double{c[4]}, double{c[2]},
        double{c[4]}, double{c[5]};
    covariance = Eigen::Matrix3d(linear * covariance * linear.transpose());
    PointGaussian moved = copy_all_fields ? point : PointGaussian{};
    moved.getVector3fMap() = (linear * point.getVector3fMap().cast<double>() + offset).cast<float>();
    moved.data[3] = 1.0f;
    int element = 0;
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        moved.covariance[element++] = static_cast<float>(covariance(row, column));
    point = moved;
  }
}

}  // namespace gaussmap
