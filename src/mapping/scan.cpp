// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mapping/scan.h"

#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap {

Scan loadScan(const ScanSource& source, ScanFrame frame) {
  const PcdReader reader(source.path);
  Scan scan;
  scan.pose = source.pose;
  if (reader.header().height > 1) scan.columns = static_cast<int>(reader.header().width);
  scan.points.reserve(reader.size());
  PointBlock<3> block;
  for (reader.read(0, block); block.size > 0; reader.read(scan.points.size(), block))
    for (std::size_t i = 0; i < block.size; ++i)
      scan.points.emplace_back(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
  reader.requireWhole();
  if (frame == ScanFrame::Map) {
    const Eigen::Matrix3d to_sensor = scan.pose.rotation.toRotationMatrix().transpose();
    for (Eigen::Vector3d& point : scan.points) point = to_sensor * (point - scan.pose.translation);
  }
  return scan;
}

}  // namespace gaussmap
