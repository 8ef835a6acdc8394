// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/scans.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace gaussmap {
namespace {

/// Reads one scan of MemoryScans, which must outlive the reader.
class MemoryScanReader : public ScanReader {
 public:
  explicit MemoryScanReader(const Scan& scan) : scan_(scan) {}

  std::size_t size() const override { return scan_.points.size(); }
  int columns() const override { return scan_.columns; }
  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(PointBlock<3>::kCapacity, size() - first) : 0;
    for (std::size_t i = 0; i < block.size; ++i)
      for (int axis = 0; axis < 3; ++axis) block.coordinate[axis][i] = scan_.points[first + i](axis);
  }

 private:
  const Scan& scan_;
};

}  // namespace

void transform(const Pose& pose, PointBlock<3>& block) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = pose.translation;
  double* x = block.coordinate[0];
  double* y = block.coordinate[1];
  double* z = block.coordinate[2];
  for (std::size_t i = 0; i < block.size; ++i) {
    const double px = x[i], py = y[i], pz = z[i];
    x[i] = rotation(0, 0) * px + rotation(0, 1) * py + rotation(0, 2) * pz + t.x();
    y[i] = rotation(1, 0) * px + rotation(1, 1) * py + rotation(1, 2) * pz + t.y();
    z[i] = rotation(2, 0) * px + rotation(2, 1) * py + rotation(2, 2) * pz + t.z();
  }
}

PointCounts& PointCounts::operator+=(const PointCounts& other) {
  read += other.read;
  accepted += other.accepted;
  non_finite += other.non_finite;
  at_sensor += other.at_sensor;
  beyond_range += other.beyond_range;
  too_near += other.too_near;
  outside += other.outside;
  return *this;
}

std::vector<double> ScanReader::values(const std::string& name) const {
  throw std::out_of_range("the points have no value '" + name + "'");
}

Scan Scans::read(std::size_t index) const {
  const ScanInfo about = info(index);
  const std::unique_ptr<ScanReader> reader = open(index);
  Scan scan{{}, about.pose, reader->columns(), about.time};
  scan.points.reserve(reader->size());
  PointBlock<3> block;
  for (reader->read(0, block); block.size > 0; reader->read(scan.points.size(), block))
    for (std::size_t i = 0; i < block.size; ++i)
      scan.points.emplace_back(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
  reader->requireWhole();
  if (frame() == ScanFrame::Map) {
    const Eigen::Matrix3d to_sensor = scan.pose.rotation.toRotationMatrix().transpose();
    for (Eigen::Vector3d& point : scan.points) point = to_sensor * (point - scan.pose.translation);
  }
  return scan;
}

MemoryScans::MemoryScans(std::vector<Scan> scans, ScanFrame frame) : frame_(frame) {
  for (Scan& scan : scans) add(std::move(scan));
}

void MemoryScans::add(Scan scan) {
  if (const std::string fault = poseFault(scan.pose); !fault.empty())
    throw std::invalid_argument("scan " + std::to_string(scans_.size()) + ": " + fault);
  scan.pose = normalised(scan.pose);
  scans_.push_back(std::move(scan));
}

void MemoryScans::add(const PointsView& points, const Pose& pose, std::optional<double> time) {
  Scan scan{{}, pose, 0, time};
  scan.points.reserve(points.count);
  for (std::size_t i = 0; i < points.count; ++i)
    scan.points.emplace_back(double(points[i][0]), double(points[i][1]), double(points[i][2]));
  add(std::move(scan));
}

ScanInfo MemoryScans::info(std::size_t index) const {
  const Scan& scan = scans_.at(index);
  return {"scan " + std::to_string(index), scan.pose, scan.time};
}

std::unique_ptr<ScanReader> MemoryScans::open(std::size_t index) const {
  return std::make_unique<MemoryScanReader>(scans_.at(index));
}

}  // namespace gaussmap
