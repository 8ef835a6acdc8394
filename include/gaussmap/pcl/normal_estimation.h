// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/features/feature.h>
#include <pcl/point_types.h>
#include <pcl/impl/pcl_base.hpp>  // a user's own point type has no other

#include <algorithm>
#include <cmath>
#include <exception>
#include <vector>

#include "gaussmap/points/normals.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Normals and curvatures of a cloud from cells of several sizes, pointNormals(): used like pcl::NormalEstimationOMP,
/// without a search for neighbours, so a search method and a radius have no effect (a radius is warned of). Any point
/// type with x, y, z; PointOutT needs normal and curvature.
///
/// As with PCL's own class: normals look towards setViewPoint(), else the sensor's origin of the input cloud; there are
/// normals for the points of setIndices(); setSearchSurface() gives the points that they are made of; an organised
/// cloud stays organised; where there is no normal there is NaN, and the output is not dense.
template <typename PointInT, typename PointOutT = pcl::Normal>
class GAUSSMAP_API CellNormalEstimation : public pcl::Feature<PointInT, PointOutT> {
  using Base = pcl::Feature<PointInT, PointOutT>;

 public:
  using Ptr = pcl::shared_ptr<CellNormalEstimation>;
  using ConstPtr = pcl::shared_ptr<const CellNormalEstimation>;
  using PointCloudConstPtr = typename Base::PointCloudConstPtr;
  using PointCloudOut = typename Base::PointCloudOut;

  explicit CellNormalEstimation(const PointNormalOptions& options = {}) : options_(options) {
    this->feature_name_ = "CellNormalEstimation";
  }

  /// The points that a plane is made of are at least so many. setKSearch(k) does the same with 0.7 k: the planes are
  /// then made of about k points.
  void setMinPoints(int points) {
    options_.min_points = points;
    this->k_ = 0;
  }
  /// 0 = all; never shows in the result.
  void setNumberOfThreads(int threads) { options_.threads = threads; }

  void setInputCloud(const PointCloudConstPtr& cloud) override {
    this->input_ = cloud;
    if (use_sensor_origin_ && cloud) viewpoint_ = cloud->sensor_origin_.template head<3>();
  }
  void setViewPoint(float x, float y, float z) {
    viewpoint_ = {x, y, z};
    use_sensor_origin_ = false;
  }
  void getViewPoint(float& x, float& y, float& z) const {
    x = viewpoint_.x();
    y = viewpoint_.y();
    z = viewpoint_.z();
  }
  void useSensorOriginAsViewPoint() {
    use_sensor_origin_ = true;
    viewpoint_ = this->input_ ? Eigen::Vector3f(this->input_->sensor_origin_.template head<3>())
                              : Eigen::Vector3f(Eigen::Vector3f::Zero());
  }

 protected:
  /// No search tree is made.
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

/// The name before version 0.2. There was never a map in it.
template <typename PointInT, typename PointOutT = pcl::Normal>
using GaussianMapNormalEstimation [[deprecated("use CellNormalEstimation")]] =
    CellNormalEstimation<PointInT, PointOutT>;

extern template class CellNormalEstimation<pcl::PointXYZ, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZI, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZRGB, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointNormal, pcl::Normal>;
extern template class CellNormalEstimation<pcl::PointXYZINormal, pcl::Normal>;

}  // namespace gaussmap
