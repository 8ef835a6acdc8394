// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/features/feature.h>
#include <pcl/point_types.h>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include "gaussmap/points/normals.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Estimates normals and curvatures of a cloud with pointNormals(). It is used like pcl::NormalEstimationOMP.
///
/// The algorithm does not search for neighbours, so a search method and a radius have no effect (a radius causes a
/// warning). PointInT can be any point type with x, y, z. PointOutT needs the fields of a normal and a curvature.
///
/// As with PCL's own class, normals point towards setViewPoint(), or otherwise towards the sensor's origin of the input
/// cloud. setIndices() selects the points that get normals. setSearchSurface() sets the points from which the normals
/// are computed. An organised cloud stays organised. A point without a normal gets NaN, and the output is then not
/// dense.
template <typename PointInT, typename PointOutT = pcl::Normal>
class GAUSSMAP_API CellNormalEstimation : public pcl::Feature<PointInT, PointOutT> {
  using Base = pcl::Feature<PointInT, PointOutT>;

 public:
  using Ptr = pcl::shared_ptr<CellNormalEstimation>;             ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const CellNormalEstimation>;  ///< shared pointer to const
  using PointCloudConstPtr = typename Base::PointCloudConstPtr;  ///< input
  using PointCloudOut = typename Base::PointCloudOut;            ///< output

  /// Stores the options. They are checked by compute().
  explicit CellNormalEstimation(const PointNormalOptions& options = {}) : options_(options) {
    this->feature_name_ = "CellNormalEstimation";
  }

  /// Sets the minimum number of points per plane. setKSearch(k) sets this minimum to 0.7 k (at least 3), because planes
  /// have more points than the minimum, on average about k.
  void setMinPoints(int points) {
    options_.min_points = points;
    this->k_ = 0;
  }
  /// Sets the number of threads; 0 = all cores.
  void setNumberOfThreads(int threads) { options_.threads = threads; }

  /// Sets the cloud whose points get normals. Its sensor origin becomes the viewpoint, unless setViewPoint() was
  /// called.
  void setInputCloud(const PointCloudConstPtr& cloud) override {
    this->input_ = cloud;
    if (use_sensor_origin_ && cloud) viewpoint_ = cloud->sensor_origin_.template head<3>();
  }
  /// Sets the viewpoint.
  void setViewPoint(float x, float y, float z) {
    viewpoint_ = {x, y, z};
    use_sensor_origin_ = false;
  }
  /// Returns the viewpoint.
  void getViewPoint(float& x, float& y, float& z) const {
    x = viewpoint_.x();
    y = viewpoint_.y();
    z = viewpoint_.z();
  }
  /// Uses the sensor origin of the input cloud as the viewpoint again.
  void useSensorOriginAsViewPoint() {
    use_sensor_origin_ = true;
    viewpoint_ = this->input_ ? Eigen::Vector3f(this->input_->sensor_origin_.template head<3>())
                              : Eigen::Vector3f(Eigen::Vector3f::Zero());
  }

 protected:
  /// Checks the input. Unlike PCL's version, it builds no search tree.
  bool initCompute() override {
    if (!pcl::PCLBase<PointInT>::initCompute() || this->input_->empty()) {
      PCL_ERROR("[gaussmap::%s::compute] %s\n", this->getClassName().c_str(),
                this->input_ ? "an empty cloud" : "no cloud");
      return false;
    }
    if (this->search_radius_ != 0.0)
      PCL_WARN("[gaussmap::%s::compute] there is no search radius\n", this->getClassName().c_str());
    this->fake_surface_ = !this->surface_;
    if (this->fake_surface_) this->surface_ = this->input_;
    return true;
  }

  void computeFeature(PointCloudOut& output) override {
    const auto& surface = *this->surface_;
    PointNormalOptions options = options_;
    options.viewpoint = viewpoint_.template cast<double>();
    if (this->k_ > 0) options.min_points = std::max(3, static_cast<int>(std::lround(0.7 * this->k_)));
    const PointsView from{surface.empty() ? nullptr : surface[0].data, surface.size(), kStride};
    std::vector<float> chosen;
    PointsView queries{(*this->input_)[0].data, this->input_->size(), kStride};
    if (!isWholeInput()) {
      for (const auto index : *this->indices_) {
        const float* const point = (*this->input_)[static_cast<std::size_t>(index)].data;
        chosen.insert(chosen.end(), point, point + 3);
      }
      queries = {chosen.data(), this->indices_->size(), 3};
    }
    try {
      std::size_t without = 0;
      if (!output.empty())
        without = pointNormals(from, queries,
                               {output[0].normal, &output[0].curvature, sizeof(PointOutT) / sizeof(float)}, options);
      output.is_dense = without == 0;
    } catch (const std::exception& error) {
      PCL_ERROR("[gaussmap::%s::compute] %s\n", this->getClassName().c_str(), error.what());
      output.clear();
    }
  }

 private:
  static constexpr std::size_t kStride = sizeof(PointInT) / sizeof(float);

  bool isWholeInput() const {
    if (this->indices_->size() != this->input_->size()) return false;
    for (std::size_t i = 0; i < this->indices_->size(); ++i)
      if (static_cast<std::size_t>((*this->indices_)[i]) != i) return false;
    return true;
  }

  PointNormalOptions options_;
  Eigen::Vector3f viewpoint_ = Eigen::Vector3f::Zero();
  bool use_sensor_origin_ = true;
};

/// The name before version 0.2. It was misleading, because the class uses no map.
template <typename PointInT, typename PointOutT = pcl::Normal>
using GaussianMapNormalEstimation [[deprecated("use CellNormalEstimation")]] =
    CellNormalEstimation<PointInT, PointOutT>;

extern template class CellNormalEstimation<pcl::PointXYZ, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZI, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZRGB, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointNormal, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZINormal, pcl::Normal>;

}  // namespace gaussmap
