// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "registration_data.h"

namespace gaussmap::benchmark {

/// Two scans, prepared: what a method does once per pair.
class Prepared {
 public:
  virtual ~Prepared() = default;
  virtual Pose align(const Pose& guess) = 0;
};

struct Method {
  std::string name;
  std::function<std::unique_ptr<Prepared>(const ScanPair&)> prepare;
};

/// Sizes as a user chooses them for the place [m].
struct Sizes {
  double map;       ///< finest cells of the map
  double ndt;       ///< voxels of pcl NDT
  float ndt_leaf;   ///< its source goes through a pcl::VoxelGrid of this leaf
  float gicp_leaf;  ///< both clouds do
};
constexpr Sizes kOutdoor{0.5, 1.0, 0.2f, 0.35f};  // the defaults of the two, the leaf of PCL's NDT tutorial
constexpr Sizes kIndoor{0.2, 0.5, 0.1f, 0.1f};

/// GaussianMapRegistration with its defaults.
Method gaussianMap(const Sizes& sizes);
/// pcl::NormalDistributionsTransform as in PCL's tutorial: step .1, 35 iterations; but epsilon 1e-4: with the
/// tutorial's .01 it stops after one step.
Method pclNdt(const Sizes& sizes);
/// pcl::GeneralizedIterativeClosestPoint with its defaults.
Method pclGicp(const Sizes& sizes);

}  // namespace gaussmap::benchmark
