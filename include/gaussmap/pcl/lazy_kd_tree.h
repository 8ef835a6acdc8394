// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/search/kdtree.h>

#include <limits>
#include <vector>

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

}  // namespace gaussmap
