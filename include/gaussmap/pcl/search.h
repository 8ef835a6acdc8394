// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>
#include <pcl/impl/pcl_base.hpp>       // required for user-defined point types
#include <pcl/search/impl/search.hpp>  // required for user-defined point types

#include <exception>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "gaussmap/core/scans.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/pcl/point_gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {
namespace detail {

/// The search tree of GaussianMapSearch.
class GAUSSMAP_API CloudSearch {
 public:
  CloudSearch() = default;
  /// Sorts the finite points. `indices`: the points to use; null: all.
  CloudSearch(const PointsView& points, const pcl::Indices* indices);
  /// Both functions return the number of points found, which is 0 if the query is not finite. `point`: x, y, z.
  int nearest(const float* point, int k, pcl::Indices& indices, std::vector<float>& squares) const;
  int within(const float* point, double radius, unsigned max_count, bool sorted, pcl::Indices& indices,
             std::vector<float>& squares) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// The means of one scale of a map, or of its leaves, relative to `origin` [m, map frame], and their GaussianIds.
struct GAUSSMAP_API MapMeans {
  MapMeans(const GaussianMapOctree& map, std::optional<int> scale);
  std::vector<GaussianId> ids;
  std::vector<Eigen::Vector3f> means;
  pcl::PointCloud<PointGaussian> gaussians(const GaussianMapOctree& map) const;
  Eigen::Vector3d origin;
};

}  // namespace detail

/// Searches for neighbours in a cloud, or among the Gaussians of a map. It can be used wherever PCL takes a
/// pcl::search::Search, for example with pcl::NormalEstimation or pcl::EuclideanClusterExtraction.
///
/// The points are sorted along a space-filling curve, under a tree of bounding boxes. Construction and queries take
/// about half the time of a pcl::search::KdTree (`gaussmap_benchmark search` compares them). PointT can be any point
/// type with x, y, z.
///
/// - The results are exact: they are the same as those of a comparison with all points. Distances are computed in
///   floats. Points at equal distances are ordered by index.
/// - nearestKSearch() sorts its results by distance. So does radiusSearch(), unless setSortedResults(false) was called.
/// - radiusSearch() includes points at exactly the radius, like pcl::search::BruteForce and pcl::search::Octree, but
///   unlike pcl::search::KdTree. A radius of 0 finds nothing. If more than `max_nn` points are within the radius, it
///   returns the nearest of them, like KdTree.
/// - Points that are not finite are never found. A query that is not finite finds nothing and returns 0, also in debug
///   builds, where PCL's own classes stop the program.
/// - Several threads can search at the same time.
template <typename PointT>
class GAUSSMAP_API GaussianMapSearch : public pcl::search::Search<PointT> {
  using Base = pcl::search::Search<PointT>;

 public:
  using Ptr = pcl::shared_ptr<GaussianMapSearch>;                ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const GaussianMapSearch>;     ///< shared pointer to const
  using PointCloud = typename Base::PointCloud;                  ///< the searched points
  using PointCloudConstPtr = typename Base::PointCloudConstPtr;  ///< shared pointer to the searched points
  using IndicesConstPtr = typename Base::IndicesConstPtr;        ///< shared pointer to indices
  /// Return type of setInputCloud(): void, or bool in newer versions of PCL.
  using Accepted = decltype(std::declval<Base&>().setInputCloud(std::declval<const PointCloudConstPtr&>(),
                                                                std::declval<const IndicesConstPtr&>()));

  using Base::nearestKSearch;
  using Base::radiusSearch;

  /// Makes a search without points.
  explicit GaussianMapSearch(bool sorted = true) : Base("GaussianMapSearch", sorted) {}

  /// Sets the cloud to search. With `indices`, only these points are searched. Results are always indices of the cloud.
  Accepted setInputCloud(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices = IndicesConstPtr()) override {
    setPoints(cloud, indices);
    gaussians_.clear();
    return static_cast<Accepted>(cloud != nullptr);
  }

  /// Sets the Gaussians to search: those of one scale of a map, or of its leaves (see leaves()). The search uses copies
  /// of their means, so the map may be changed or deleted afterwards.
  ///
  /// getInputCloud() returns the means as a cloud. If PointT is PointGaussian, all fields are set; otherwise only x, y
  /// and z. As in toPointCloud(), the means are relative to the cloud's sensor_origin_, and so must be the queries. The
  /// origin is zero unless the map is far from the origin of the map frame. Throws std::out_of_range if the map does
  /// not have the scale.
  void setInputMap(const GaussianMapOctree& map, std::optional<int> scale = std::nullopt) {
    detail::MapMeans means(map, scale);
    auto cloud = pcl::make_shared<PointCloud>();
    if constexpr (std::is_same_v<PointT, PointGaussian>) {
      *cloud = means.gaussians(map);
    } else {
      cloud->resize(means.means.size());
      for (std::size_t i = 0; i < means.means.size(); ++i) (*cloud)[i].getVector3fMap() = means.means[i];
    }
    cloud->sensor_origin_.template head<3>() = means.origin.template cast<float>();
    setPoints(cloud, nullptr);
    gaussians_ = std::move(means.ids);
  }
  /// Returns, per point of getInputCloud(), the Gaussian of the map from which it comes. Empty after setInputCloud().
  const std::vector<GaussianId>& getGaussians() const { return gaussians_; }

  /// Finds the `k` nearest points, or all if there are fewer. Returns their number.
  int nearestKSearch(const PointT& point, int k, pcl::Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override {
    return search_.nearest(point.data, k, k_indices, k_sqr_distances);
  }
  /// Finds all points within a radius [m], or the nearest `max_nn` of them if `max_nn` > 0. Returns their number.
  int radiusSearch(const PointT& point, double radius, pcl::Indices& k_indices, std::vector<float>& k_sqr_distances,
                   unsigned int max_nn = 0) const override {
    return search_.within(point.data, radius, max_nn, this->sorted_results_, k_indices, k_sqr_distances);
  }

 private:
  void setPoints(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices) {
    static_assert(sizeof(PointT) % sizeof(float) == 0);
    this->input_ = cloud;
    this->indices_ = indices;
    search_ = {};
    if (!cloud) {
      PCL_ERROR("[gaussmap::%s::setInputCloud] no cloud\n", this->getName().c_str());
      return;
    }
    if (cloud->empty()) return;
    search_ = detail::CloudSearch({(*cloud)[0].data, cloud->size(), sizeof(PointT) / sizeof(float)}, indices.get());
  }

  detail::CloudSearch search_;
  std::vector<GaussianId> gaussians_;
};

extern template class GaussianMapSearch<pcl::PointXYZ>;
extern template class GaussianMapSearch<pcl::PointXYZI>;
extern template class GaussianMapSearch<pcl::PointXYZRGB>;
extern template class GaussianMapSearch<pcl::PointNormal>;
extern template class GaussianMapSearch<pcl::PointXYZINormal>;
extern template class GaussianMapSearch<PointGaussian>;

}  // namespace gaussmap
