// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/common/transforms.h>
#include <pcl/console/print.h>
#include <pcl/type_traits.h>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/map/queries.h"

namespace gaussmap {

template <typename PointSource, typename PointTarget, typename Scalar>
GaussianMapRegistration<PointSource, PointTarget, Scalar>::GaussianMapRegistration(
    const GaussianMapRegistrationOptions& options)
    : options_(options), lazy_tree_(new Tree) {
  this->reg_name_ = "GaussianMapRegistration";
  this->max_iterations_ = options.registration.max_iterations;
  this->transformation_epsilon_ = options.registration.translation * options.registration.translation;
  this->transformation_rotation_epsilon_ = std::cos(options.registration.rotation);
  this->setSearchMethodTarget(lazy_tree_, true);  // true: align() builds no tree
}

template <typename PointSource, typename PointTarget, typename Scalar>
void GaussianMapRegistration<PointSource, PointTarget, Scalar>::setInputTarget(const PointCloudTargetConstPtr& cloud) {
  if (!cloud) {
    PCL_ERROR("[gaussmap::%s::setInputTarget] no cloud\n", this->getClassName().c_str());
    return;
  }
  Base::setInputTarget(cloud);  // prints an error if the cloud is empty
  if (cloud->empty()) return;
  map_.reset();
  map_given_ = false;
  lazy_tree_->setCloud(cloud);
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool GaussianMapRegistration<PointSource, PointTarget, Scalar>::setTargetMap(const MapConstPtr& map) {
  if (!map || map->empty()) {
    PCL_ERROR("[gaussmap::%s::setTargetMap] %s\n", this->getClassName().c_str(), map ? "an empty map" : "no map");
    return false;
  }
  auto means = pcl::make_shared<PointCloudTarget>();
  for (const GaussianId& leaf : leaves(*map)) {
    PointTarget point{};
    point.getVector3fMap() = map->gaussian(leaf.index, leaf.scale).mean.template cast<float>();
    means->push_back(point);
  }
  setInputTarget(means);
  map_ = map;
  map_given_ = true;
  return true;
}

template <typename PointSource, typename PointTarget, typename Scalar>
bool GaussianMapRegistration<PointSource, PointTarget, Scalar>::setTargetMap(const std::filesystem::path& path) {
  try {
    return setTargetMap(std::make_shared<const GaussianMapOctree>(loadAny(path)));
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::%s::setTargetMap] %s\n", this->getClassName().c_str(), error.what());
    return false;
  }
}

template <typename PointSource, typename PointTarget, typename Scalar>
auto GaussianMapRegistration<PointSource, PointTarget, Scalar>::getTargetMap() -> MapConstPtr {
  if (map_ || !this->target_) return map_;
  std::vector<Eigen::Vector3d> points;
  points.reserve(this->target_->size());
  for (const PointTarget& point : *this->target_) points.push_back(point.getVector3fMap().template cast<double>());
  try {
    map_ = std::make_shared<const GaussianMapOctree>(buildTargetMap(points, options_));
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::%s] %s\n", this->getClassName().c_str(), error.what());
  }
  return map_;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void GaussianMapRegistration<PointSource, PointTarget, Scalar>::setResolution(double side) {
  if (!map_given_ && side != options_.map.resolution) map_.reset();
  options_.map.resolution = side;
}

template <typename PointSource, typename PointTarget, typename Scalar>
RegistrationOptions GaussianMapRegistration<PointSource, PointTarget, Scalar>::registrationOptions() const {
  RegistrationOptions options = options_.registration;
  options.max_iterations = this->max_iterations_;
  // As in pcl::NormalDistributionsTransform: a limit of 0 or less is not tested. Without any limit, only a step of
  // length zero ends the iterations early.
  const double squared = this->transformation_epsilon_, cosine = this->transformation_rotation_epsilon_;
  constexpr double kSmallest = std::numeric_limits<double>::min(), kNoLimit = std::numeric_limits<double>::infinity();
  const bool no_limit = !(squared > 0.0) && !(cosine > 0.0);
  options.translation = squared > 0.0 ? std::sqrt(squared) : no_limit ? kSmallest : kNoLimit;
  options.rotation = cosine > 0.0 ? std::max(kSmallest, std::acos(std::min(1.0, cosine)))
                     : no_limit   ? kSmallest
                                  : kNoLimit;
  return options;
}

template <typename PointSource, typename PointTarget, typename Scalar>
void GaussianMapRegistration<PointSource, PointTarget, Scalar>::computeTransformation(PointCloudSource& output,
                                                                                      const Matrix4& guess) {
  result_ = {};
  this->nr_iterations_ = 0;
  this->final_transformation_ = guess;
  try {
    const Pose start = poseOfMatrix(guess.template cast<double>());
    result_.pose = start;
    std::vector<Eigen::Vector3d> points;
    points.reserve(output.size());
    for (const PointSource& point : output) points.push_back(point.getVector3fMap().template cast<double>());
    if (const MapConstPtr map = getTargetMap()) result_ = registerScan(points, *map, start, registrationOptions());
    const Eigen::Matrix4d found = matrixOf(result_.pose), before = guess.template cast<double>();
    this->final_transformation_ = found.template cast<Scalar>();
    this->transformation_ = (found * before.inverse()).template cast<Scalar>();
    this->nr_iterations_ = result_.iterations;
    this->converged_ = result_.converged;
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::%s::computeTransformation] %s\n", this->getClassName().c_str(), error.what());
  }
  if constexpr (pcl::traits::has_normal<PointSource>::value)
    pcl::transformPointCloudWithNormals(output, output, this->final_transformation_);
  else
    pcl::transformPointCloud(output, output, this->final_transformation_);
  if (this->update_visualizer_) this->update_visualizer_(output, {}, *this->target_, {});
}

}  // namespace gaussmap
