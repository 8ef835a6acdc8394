// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "registration_data.h"

namespace gaussmap::benchmark {

/// Two scans, prepared: the work that a method does once per pair.
class Prepared {
 public:
  virtual ~Prepared() = default;
  virtual Pose align(const Pose& guess) = 0;
};

struct Method {
  std::string name;
  std::function<std::unique_ptr<Prepared>(const ScanPair&)> prepare;
};

/// Sizes that a user would choose for the place [m].
struct Sizes {
  double map;       ///< finest cells of the map
  double ndt;       ///< voxels of pcl NDT
  float ndt_leaf;   ///< leaf of the pcl::VoxelGrid that filters the source of NDT
  float gicp_leaf;  ///< leaf of the pcl::VoxelGrid that filters both clouds of GICP
};
constexpr Sizes kOutdoor{0.5, 1.0, 0.2f, 0.35f};  // map, ndt: their defaults; ndt_leaf: as in PCL's NDT tutorial
constexpr Sizes kIndoor{0.2, 0.5, 0.1f, 0.1f};

/// Returns GaussianMapRegistration with its defaults.
Method gaussianMap(const Sizes& sizes);
/// Returns pcl::NormalDistributionsTransform as in PCL's tutorial (step 0.1, 35 iterations), but with epsilon 1e-4.
/// With the 0.01 of the tutorial it stops after one step.
Method pclNdt(const Sizes& sizes);
/// Returns pcl::GeneralizedIterativeClosestPoint with its defaults.
Method pclGicp(const Sizes& sizes);

}  // namespace gaussmap::benchmark
