// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_types.h>
#include <pcl/registration/registration.h>
#include <pcl/search/kdtree.h>
#include <limits>

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/registration/registration.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A kd-tree that is made when it is first asked. A point that is not finite, or a tree of nothing, has no neighbour:
/// the distance is then infinite.
template <typename PointT>
class LazyKdTree : public pcl::search::KdTree<PointT> {
  using Base = pcl::search::KdTree<PointT>;

 public:
  using LazyPtr = pcl::shared_ptr<LazyKdTree>;
  using typename Base::PointCloudConstPtr;

  /// Unlike setInputCloud(), this makes no tree yet.
  void setCloud(const PointCloudConstPtr& cloud) {
    this->input_ = cloud;
    made_ = false;
  }

  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices, std::vector<float>& squared) const override {
    if (make(point)) return Base::nearestKSearch(point, k, indices, squared);
    indices.assign(1, 0);
    squared.assign(1, std::numeric_limits<float>::infinity());
    return 0;
  }
  int radiusSearch(const PointT& point, double radius, pcl::Indices& indices, std::vector<float>& squared,
                   unsigned int most = 0) const override {
    if (make(point)) return Base::radiusSearch(point, radius, indices, squared, most);
    indices.clear();
    squared.clear();
    return 0;
  }
  using Base::nearestKSearch;
  using Base::radiusSearch;

 private:
  /// False if there is nothing to look in or for.
  bool make(const PointT& point) const {
    if (!this->input_ || !point.getVector3fMap().allFinite()) return false;
    if (!made_) this->tree_->setInputCloud(this->input_);
    made_ = true;
    return this->tree_->getInputCloud() != nullptr;
  }

  mutable bool made_ = false;
};

struct GaussianMapRegistrationOptions {
  MapOptions map{0.5, 3, 4, 0.0};  ///< of the map that is made of a target cloud
  double budget = 3.0;             ///< Gaussians of its coarse scales per cell, PerCell::gaussians
  RegistrationOptions registration;
};

/// registerScan() for PCL: used like pcl::NormalDistributionsTransform. The target is a cloud, of which a map is made
/// once, or a map that was made before. Any point type with x, y, z; neither normals nor covariances are needed.
///
/// As with PCL's own classes: points that are not finite count for nothing, setIndices() chooses points of the source,
/// errors are printed and leave hasConverged() false, final transformation and output then being those of the guess.
/// setMaximumIterations(), setTransformationEpsilon() (a squared length) and setTransformationRotationEpsilon() (a
/// cosine) hold for each step from coarse to fine; the constructor takes them from the options. What PCL offers to
/// choose correspondences has no effect. The kd-tree of the target is made when getFitnessScore() first asks for it.
template <typename PointSource, typename PointTarget, typename Scalar = float>
class GAUSSMAP_API GaussianMapRegistration : public pcl::Registration<PointSource, PointTarget, Scalar> {
  using Base = pcl::Registration<PointSource, PointTarget, Scalar>;

 public:
  using Ptr = pcl::shared_ptr<GaussianMapRegistration>;
  using ConstPtr = pcl::shared_ptr<const GaussianMapRegistration>;
  using Matrix4 = typename Base::Matrix4;
  using PointCloudSource = typename Base::PointCloudSource;
  using PointCloudTarget = typename Base::PointCloudTarget;
  using PointCloudTargetConstPtr = typename Base::PointCloudTargetConstPtr;
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;

  explicit GaussianMapRegistration(const GaussianMapRegistrationOptions& options = {});

  /// The cloud to align with; its map is made by the next align(). An empty cloud changes nothing.
  void setInputTarget(const PointCloudTargetConstPtr& cloud) override;
  /// The map to align with. The means of its finest Gaussians become getInputTarget(). False for none or an empty one:
  /// an error is printed, nothing changes.
  bool setTargetMap(const MapConstPtr& map);
  /// The same for a .gmap or a PCD file of Gaussians.
  bool setTargetMap(const std::filesystem::path& path);
  /// The map to align with, made now if need be. Null if there is none.
  MapConstPtr getTargetMap();

  /// Side of the finest cells of the map that is made of a target cloud [m], as in pcl::NormalDistributionsTransform.
  void setResolution(double side);
  double getResolution() const { return options_.map.resolution; }
  /// 0 = all; never shows in the result.
  void setNumberOfThreads(int threads) { options_.registration.threads = threads; }

  /// Of the pose of the source in the frame of the target; zero if nothing is known.
  const PoseCovariance& getPoseCovariance() const { return result_.covariance; }
  /// True if the source does not tell some direction of the pose, as in a corridor, or nothing.
  bool isDegenerate() const { return result_.degenerate; }
  /// All that is known of the last align().
  const RegistrationResult& result() const { return result_; }

 protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

 private:
  using Tree = LazyKdTree<PointTarget>;

  RegistrationOptions registrationOptions() const;

  GaussianMapRegistrationOptions options_;
  RegistrationResult result_;
  MapConstPtr map_;  // null: to be made of the target cloud
  bool map_given_ = false;
  typename Tree::LazyPtr lazy_tree_;
};

/// The map that a target cloud is aligned with. Throws as build() and refine().
GAUSSMAP_API GaussianMapOctree buildTargetMap(const std::vector<Eigen::Vector3d>& points,
                                              const GaussianMapRegistrationOptions& options);
/// A rigid 4 x 4 transform as a pose. Throws std::invalid_argument for one that is none.
GAUSSMAP_API Pose poseOfMatrix(const Eigen::Matrix4d& matrix);
GAUSSMAP_API Eigen::Matrix4d matrixOf(const Pose& pose);

}  // namespace gaussmap

#include "gaussmap/pcl/impl/registration.hpp"

namespace gaussmap {

extern template class GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ>;
extern template class GaussianMapRegistration<pcl::PointXYZI, pcl::PointXYZI>;
extern template class GaussianMapRegistration<pcl::PointXYZRGB, pcl::PointXYZRGB>;
extern template class GaussianMapRegistration<pcl::PointNormal, pcl::PointNormal>;
extern template class GaussianMapRegistration<pcl::PointXYZINormal, pcl::PointXYZINormal>;

}  // namespace gaussmap
