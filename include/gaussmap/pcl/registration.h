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

/// A kd-tree that is built at the first search. If the point is not finite or the tree is empty, the search finds no
/// neighbour, and the distance is infinite.
template <typename PointT>
class LazyKdTree : public pcl::search::KdTree<PointT> {
  using Base = pcl::search::KdTree<PointT>;

 public:
  using LazyPtr = pcl::shared_ptr<LazyKdTree>;  ///< shared pointer
  using typename Base::PointCloudConstPtr;

  /// Sets the cloud. Unlike setInputCloud(), this function does not build the tree yet.
  void setCloud(const PointCloudConstPtr& cloud) {
    this->input_ = cloud;
    made_ = false;
  }

  /// Finds the `k` nearest neighbours of a point, as in PCL.
  int nearestKSearch(const PointT& point, int k, pcl::Indices& indices, std::vector<float>& squared) const override {
    if (make(point)) return Base::nearestKSearch(point, k, indices, squared);
    indices.assign(1, 0);
    squared.assign(1, std::numeric_limits<float>::infinity());
    return 0;
  }
  /// Finds all neighbours of a point within `radius` [m], or at most `most` of them if `most` > 0, as in PCL.
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
  /// Builds the tree if necessary. Returns false if there is no cloud or the point is not finite.
  bool make(const PointT& point) const {
    if (!this->input_ || !point.getVector3fMap().allFinite()) return false;
    if (!made_) this->tree_->setInputCloud(this->input_);
    made_ = true;
    return this->tree_->getInputCloud() != nullptr;
  }

  mutable bool made_ = false;
};

/// Options of GaussianMapRegistration.
struct GaussianMapRegistrationOptions {
  MapOptions map{0.5, 3, 4, 0.0};    ///< options of the map that is built from a target cloud
  double budget = 3.0;               ///< maximum mean number of Gaussians per cell of its coarse scales, see PerCell
  RegistrationOptions registration;  ///< options of registerScan()
};

/// Registers a cloud to a map with registerScan(). It is used like pcl::NormalDistributionsTransform.
///
/// The target is a cloud, from which a map is built once, or an existing map. Any point type with x, y, z can be used;
/// normals and covariances are not needed.
///
/// As with PCL's own classes, non-finite points are ignored, and setIndices() selects points of the source. After an
/// error, which is printed, hasConverged() is false, and the final transformation is the guess.
///
/// The registration works in steps, from coarse to fine, and these settings apply to each step:
/// - setMaximumIterations(). If the last step reaches this limit, hasConverged() is false, unlike in PCL's classes.
/// - setTransformationEpsilon() and setTransformationRotationEpsilon(), with the meaning that they have in
///   pcl::NormalDistributionsTransform. A step ends when the squared length of the last translation [m^2] is at most
///   the first value, and the cosine of the angle of the last rotation is at least the second value. If one of the two
///   values is 0 or less, only the other one counts. If both are 0 or less, a step ends at the limit of iterations, or
///   when the pose no longer improves. Steps before the last one can end at larger changes.
///
/// The constructor sets all three from the RegistrationOptions; the setters replace these values. PCL's settings of
/// correspondences have no effect. getLastIncrementalTransformation() is the motion from the guess to the result. The
/// kd-tree of the target is built at the first call of getFitnessScore().
///
/// Along unobservable directions the result keeps the guess, see RegistrationResult. If the target gives no information
/// about the pose, for example because it is a single point, hasConverged() is false.
template <typename PointSource, typename PointTarget, typename Scalar = float>
class GAUSSMAP_API GaussianMapRegistration : public pcl::Registration<PointSource, PointTarget, Scalar> {
  using Base = pcl::Registration<PointSource, PointTarget, Scalar>;

 public:
  using Ptr = pcl::shared_ptr<GaussianMapRegistration>;                      ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const GaussianMapRegistration>;           ///< shared pointer to const
  using Matrix4 = typename Base::Matrix4;                                    ///< 4 x 4 transform
  using PointCloudSource = typename Base::PointCloudSource;                  ///< source cloud
  using PointCloudTarget = typename Base::PointCloudTarget;                  ///< target cloud
  using PointCloudTargetConstPtr = typename Base::PointCloudTargetConstPtr;  ///< shared pointer to the target cloud
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;              ///< shared pointer to the target map

  /// Stores the options. They are checked by align().
  explicit GaussianMapRegistration(const GaussianMapRegistrationOptions& options = {});

  /// Sets the target cloud. The next align() builds its map. An empty cloud is refused and changes nothing.
  void setInputTarget(const PointCloudTargetConstPtr& cloud) override;
  /// Sets the target map. The means of its leaves() become the target cloud, for getInputTarget() and
  /// getFitnessScore(). If the map is null or empty, prints an error, changes nothing and returns false.
  bool setTargetMap(const MapConstPtr& map);
  /// Sets the target map from a .gmap file or a PCD file of Gaussians. If the file cannot be read, prints an error,
  /// changes nothing and returns false.
  bool setTargetMap(const std::filesystem::path& path);
  /// Returns the target map, and builds it from the target cloud if necessary. Returns null if there is no target, or
  /// prints an error and returns null if the map cannot be built.
  MapConstPtr getTargetMap();

  /// Sets the side of the finest cells of the map that is built from a target cloud [m], as in
  /// pcl::NormalDistributionsTransform.
  void setResolution(double side);
  /// Returns the side of these cells [m].
  double getResolution() const { return options_.map.resolution; }
  /// Sets the number of threads; 0 = all cores.
  void setNumberOfThreads(int threads) { options_.registration.threads = threads; }

  /// Returns the number of iterations of all steps together, as of pcl::NormalDistributionsTransform. It can be larger
  /// than getMaximumIterations(), which is the limit per step.
  int getFinalNumIteration() const { return this->nr_iterations_; }
  /// Returns the covariance of the pose: translation x y z [m], then rotation vector about the origin of the source
  /// [rad], along the axes of the target. Unobservable directions have a large variance, see RegistrationResult. A zero
  /// matrix does not mean that the pose is exact, but that there is no information about it.
  const PoseCovariance& getPoseCovariance() const { return result_.covariance; }
  /// Returns true if some direction of the pose is unobservable, for example along a corridor, or if there is no
  /// result.
  bool isDegenerate() const { return result_.degenerate; }
  /// Returns the full result of the last align().
  const RegistrationResult& result() const { return result_; }

 protected:
  void computeTransformation(PointCloudSource& output, const Matrix4& guess) override;

 private:
  using Tree = LazyKdTree<PointTarget>;

  RegistrationOptions registrationOptions() const;

  GaussianMapRegistrationOptions options_;
  RegistrationResult result_;
  MapConstPtr map_;  // null: not yet built from the target cloud
  bool map_given_ = false;
  typename Tree::LazyPtr lazy_tree_;
};

/// Builds the target map of GaussianMapRegistration from a target cloud. Throws like build() and refine().
GAUSSMAP_API GaussianMapOctree buildTargetMap(const std::vector<Eigen::Vector3d>& points,
                                              const GaussianMapRegistrationOptions& options);
/// Converts a rigid 4 x 4 transform to a pose. Throws std::invalid_argument if the matrix is not a rigid transform.
GAUSSMAP_API Pose poseOfMatrix(const Eigen::Matrix4d& matrix);
/// Converts a pose to a 4 x 4 transform.
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
