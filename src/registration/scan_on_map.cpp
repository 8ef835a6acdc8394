// SPDX-License-Identifier: BSD-3-Clause
#include "registration/scan_on_map.h"

#include <algorithm>

#include "core/parallel.h"
#include "registration/residual_batch.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kPart = 256;  // Gaussians per partial sum, independent of threads: the order of the sums is fixed

}  // namespace

NormalEquations ScanOnMap::linearise(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const auto placed = [&](std::size_t i) -> Vector<3> { return rotation * scan_[i].mean + pose.translation; };
  for (std::size_t i = 0; i < scan_.size(); ++i) lists_[i] = near_.listAt(placed(i), lists_[i]);
  std::vector<std::uint32_t> met(scan_.size());
  parallelFor(scan_.size(), threads_, kPart, [&](std::size_t i) {
    met[i] = lists_[i] == MapNeighbours::kNone ? MapNeighbours::kNone : near_.nearest(lists_[i], placed(i));
  });
  for (const std::uint32_t i : met)
    if (i != MapNeighbours::kNone) near_.prepare(i);
  std::vector<NormalEquations> parts((scan_.size() + kPart - 1) / kPart);
  parallelFor(parts.size(), threads_, 1, [&](std::size_t part) {
    NormalEquations& sums = parts[part];
    ResidualBatch batch;
    const auto sumUp = [&] { sums += batch.sumUp(rotation, pose.translation, near_.blur() * near_.blur(), kernel_); };
    for (std::size_t i = part * kPart; i < std::min(scan_.size(), (part + 1) * kPart); ++i) {
      if (met[i] == MapNeighbours::kNone) {
        sums.cost += kernel_ * kernel_;
        continue;
      }
      batch.add(scan_[i], near_[met[i]]);
      if (batch.isFull()) sumUp();
    }
    sumUp();
  });
  NormalEquations all;
  for (const NormalEquations& part : parts) all += part;
  return all;
}

}  // namespace gaussmap::detail
