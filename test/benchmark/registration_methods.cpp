// SPDX-License-Identifier: BSD-3-Clause
// g++ 12 warns about code that it has inlined into PCL's own templates.
#pragma GCC diagnostic ignored "-Warray-bounds"
#include "registration_methods.h"

#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

#include "gaussmap/pcl/registration.h"

namespace gaussmap::benchmark {
namespace {

using Point = pcl::PointXYZ;
using Cloud = pcl::PointCloud<Point>;

Cloud::Ptr cloudOf(const Points& points) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->reserve(points.size());
  for (const Eigen::Vector3d& point : points) cloud->emplace_back(float(point.x()), float(point.y()), float(point.z()));
  return cloud;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud, float leaf) {
  pcl::VoxelGrid<Point> grid;
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(cloud);
  auto thin = pcl::make_shared<Cloud>();
  grid.filter(*thin);
  return thin;
}

class PreparedPcl : public Prepared {
 public:
  explicit PreparedPcl(pcl::Registration<Point, Point>::Ptr registration) : registration_(std::move(registration)) {}
  Pose align(const Pose& guess) override {
    Cloud moved;
    registration_->align(moved, matrixOf(guess).cast<float>());
    return poseOfMatrix(registration_->getFinalTransformation().cast<double>());
  }

 private:
  pcl::Registration<Point, Point>::Ptr registration_;
};

}  // namespace

Method gaussianMap(const Sizes& sizes) {
  return {"GaussianMapRegistration", [sizes](const ScanPair& pair) {
            auto registration = pcl::make_shared<GaussianMapRegistration<Point, Point>>();
            registration->setResolution(sizes.map);
            registration->setInputTarget(cloudOf(pair.target));
            registration->setInputSource(cloudOf(pair.source));
            registration->getTargetMap();
            return std::make_unique<PreparedPcl>(registration);
          }};
}

Method pclNdt(const Sizes& sizes) {
  return {"pcl::NormalDistributionsTransform", [sizes](const ScanPair& pair) {
            auto ndt = pcl::make_shared<pcl::NormalDistributionsTransform<Point, Point>>();
            ndt->setResolution(static_cast<float>(sizes.ndt));
            ndt->setStepSize(0.1);
            ndt->setMaximumIterations(35);
            ndt->setTransformationEpsilon(1e-4);
            ndt->setInputTarget(cloudOf(pair.target));
            ndt->setInputSource(thinned(cloudOf(pair.source), sizes.ndt_leaf));
            return std::make_unique<PreparedPcl>(ndt);
          }};
}

Method pclGicp(const Sizes& sizes) {
  return {"pcl::GeneralizedIterativeClosestPoint", [sizes](const ScanPair& pair) {
            auto gicp = pcl::make_shared<pcl::GeneralizedIterativeClosestPoint<Point, Point>>();
            gicp->setInputTarget(thinned(cloudOf(pair.target), sizes.gicp_leaf));
            gicp->setInputSource(thinned(cloudOf(pair.source), sizes.gicp_leaf));
            return std::make_unique<PreparedPcl>(gicp);
          }};
}

}  // namespace gaussmap::benchmark
