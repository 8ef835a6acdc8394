// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/filters/filter.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

#include "gaussmap/points/split_points.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What GaussianMapFilter gives out, a point a Gaussian.
enum class FilterOutput {
  Means,   ///< the means: nearest to the input
  Samples  ///< of each Gaussian the point nearest to its mean: nothing that was not measured
};

struct GaussianMapFilterOptions {
  std::size_t budget = 10000;  ///< most points that are kept, >= 1
  double max_error = 0.0;      ///< > 0: as few points (within the budget) as have 95 % of the input nearer than it [m]
  FilterOutput output = FilterOutput::Means;
  SplitRule detail = SplitRule::Distance;  ///< Shape: few points on planes; max_error is then the distance to the plane
  int rounds = 3;                          ///< SplitPointsOptions::rounds
  int threads = 0;                         ///< 0 = all; never shows in the result
};

/// Downsampling that is driven by the error: a cloud of at most so many points, or of as few as an error allows. Used
/// like pcl::VoxelGrid; for any registered point type with x, y, z.
///
/// Each kept point stands for the Gaussian of some points of the input. Of means, every other field is averaged over
/// these points (colours by channel; integers are rounded; of normals the direction; values that are not finite do not
/// count), labels are those of the point nearest to the mean. Samples are points of the input as they are. Where a
/// point then has no normal but its type has the fields, normal and curvature are those of the input's surface there
/// (pointNormals()), seen from sensor_origin_.
///
/// As with pcl::VoxelGrid the output is not organised and has no point that is not finite. setIndices() chooses points.
/// getRemovedIndices(), if asked for in the constructor: the points of the input that are not finite, and those that
/// are not the nearest to the mean of their Gaussian. A filter without cloud gives nothing; unusable options print an
/// error and give an empty cloud.
template <typename PointT>
class GAUSSMAP_API GaussianMapFilter : public pcl::Filter<PointT> {
 public:
  using Ptr = pcl::shared_ptr<GaussianMapFilter>;
  using ConstPtr = pcl::shared_ptr<const GaussianMapFilter>;
  using PointCloud = typename pcl::Filter<PointT>::PointCloud;

  explicit GaussianMapFilter(bool extract_removed_indices = false, const GaussianMapFilterOptions& options = {})
      : pcl::Filter<PointT>(extract_removed_indices), options_(options) {
    this->filter_name_ = "GaussianMapFilter";
  }

  /// Most points that are kept.
  void setBudget(std::size_t points) { options_.budget = points; }
  /// 95 % of the input shall lie within this distance of a kept point [m]; 0: the budget decides. The budget holds too:
  /// error() tells what it allowed.
  void setMaxError(double metres) { options_.max_error = metres; }
  void setOutput(FilterOutput output) { options_.output = output; }
  void setDetail(SplitRule detail) { options_.detail = detail; }
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  const GaussianMapFilterOptions& options() const { return options_; }

  /// Of the last filter(): for each point of the input the kept point that stands for it, -1 for none.
  const std::vector<std::int32_t>& getLabels() const { return labels_; }
  /// Of the last filter(): the Gaussian of each kept point, map frame of the cloud; the covariance may be singular.
  const std::vector<Gaussian<3>>& getGaussians() const { return gaussians_; }
  /// Of the last filter(): 95 % of the input lie within it of the kept point that stands for them [m].
  double error() const { return error_; }

 protected:
  void applyFilter(PointCloud& output) override;

 private:
  GaussianMapFilterOptions options_;
  std::vector<std::int32_t> labels_;
  std::vector<Gaussian<3>> gaussians_;
  double error_ = 0.0;
};

}  // namespace gaussmap

#include "gaussmap/pcl/impl/gaussian_map_filter.hpp"

namespace gaussmap {

extern template class GaussianMapFilter<pcl::PointXYZ>;
extern template class GaussianMapFilter<pcl::PointXYZI>;
extern template class GaussianMapFilter<pcl::PointXYZRGB>;
extern template class GaussianMapFilter<pcl::PointNormal>;
extern template class GaussianMapFilter<pcl::PointXYZINormal>;

}  // namespace gaussmap
