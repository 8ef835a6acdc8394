// SPDX-License-Identifier: BSD-3-Clause
#include <gaussmap/pcl/registration.h>

#include <cmath>
#include <cstdio>

int main() {
  using Cloud = pcl::PointCloud<pcl::PointXYZ>;
  const auto corner = pcl::make_shared<Cloud>();  // three planes
  for (int i = 0; i < 3000; ++i) {
    const float u = 0.002f * static_cast<float>(i), v = 0.1f * static_cast<float>(i % 60);
    corner->emplace_back(u, v, 0.0f);
    corner->emplace_back(u, 0.0f, v);
    corner->emplace_back(0.0f, u, v);
  }
  gaussmap::GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setInputTarget(corner);
  registration.setInputSource(corner);
  Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
  guess(0, 3) = 0.2f;
  Cloud aligned;
  registration.align(aligned, guess);  // with another alignment, this call crashes
  const float off = std::abs(registration.getFinalTransformation()(0, 3));
  std::printf("EIGEN_MAX_ALIGN_BYTES %d, off by %.4f m\n", EIGEN_MAX_ALIGN_BYTES, off);
  return registration.hasConverged() && off < 0.01f ? 0 : 1;
}
