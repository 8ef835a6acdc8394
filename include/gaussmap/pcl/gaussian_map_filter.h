// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/filters/filter.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <vector>

#include "gaussmap/points/split_points.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The points that GaussianMapFilter returns, one per Gaussian.
enum class FilterOutput {
  Means,   ///< the means of the Gaussians: closer to the input than samples, but not measured
  Samples  ///< the input points nearest to the means, so every output point was measured
};

/// Options of GaussianMapFilter.
struct GaussianMapFilterOptions {
  std::size_t budget = 10000;  ///< maximum number of points kept, >= 1
  /// If > 0: keeps the smallest number of points (within the budget) for which 95 % of the input lie within this
  /// distance of their output point [m]. If 0: keeps as many points as the budget allows.
  double max_error = 0.0;
  FilterOutput output = FilterOutput::Means;  ///< means or samples
  /// How the output is distributed. SplitRule::Distance: every input point gets an output point nearby.
  /// SplitRule::Shape: few points on planes, many on curved surfaces. max_error is then the distance from the plane
  /// through the output point.
  SplitRule detail = SplitRule::Distance;
  int rounds = 3;   ///< rounds of k-means after the splitting, SplitRule::Distance only, >= 0
  int threads = 0;  ///< 0 = all cores
};

/// Downsamples a cloud to a maximum number of points, or to the smallest number that keeps an error limit. It is used
/// like pcl::VoxelGrid, for any registered point type with x, y, z.
///
/// Each output point represents the Gaussian of some input points.
/// - With FilterOutput::Means, all other fields are averaged over these points: colours by channel, integers rounded,
///   normals by direction, non-finite values ignored. A label is that of the point nearest to the mean.
/// - With FilterOutput::Samples, output points are unchanged input points.
/// - An output point without a normal gets the normal and curvature of the input's surface (see pointNormals()). This
///   normal points towards sensor_origin_. All other normals are scaled to unit length, also for FilterOutput::Samples.
///   Point types without fields for a normal and a curvature have neither.
///
/// As with pcl::VoxelGrid, the output is not organised and has only finite points. setIndices() selects input points.
/// getRemovedIndices(), if enabled in the constructor, returns the input points that are not kept. Each Gaussian keeps
/// the input point that is nearest to its mean. Without an input cloud, the filter prints an error and does not change
/// the output. If an option is out of range, it prints an error and returns an empty cloud.
template <typename PointT>
class GAUSSMAP_API GaussianMapFilter : public pcl::Filter<PointT> {
 public:
  using Ptr = pcl::shared_ptr<GaussianMapFilter>;               ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const GaussianMapFilter>;    ///< shared pointer to const
  using PointCloud = typename pcl::Filter<PointT>::PointCloud;  ///< input and output

  /// Makes a filter. `extract_removed_indices` enables getRemovedIndices().
  explicit GaussianMapFilter(bool extract_removed_indices = false, const GaussianMapFilterOptions& options = {})
      : pcl::Filter<PointT>(extract_removed_indices), options_(options) {
    this->filter_name_ = "GaussianMapFilter";
  }

  /// Sets the maximum number of points kept.
  void setBudget(std::size_t points) { options_.budget = points; }
  /// Sets a distance [m]: 95 % of the input points must be at most this far from their output points. With 0, the
  /// filter keeps as many points as the budget allows. If the budget is too small for this distance, the budget
  /// decides, and error() is larger than the distance.
  void setMaxError(double metres) { options_.max_error = metres; }
  /// Selects means or samples.
  void setOutput(FilterOutput output) { options_.output = output; }
  /// Selects how the output is distributed, see GaussianMapFilterOptions::detail.
  void setDetail(SplitRule detail) { options_.detail = detail; }
  /// Sets the number of threads; 0 = all cores.
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  /// Returns the options.
  const GaussianMapFilterOptions& options() const { return options_; }

  /// Returns, for each input point of the last filter(), the index of the output point that represents it. The index is
  /// -1 for points that are not finite or not selected by setIndices(), or if an option is out of range.
  const std::vector<std::int32_t>& getLabels() const { return labels_; }
  /// Returns the Gaussian of each output point of the last filter(), in the frame of the cloud. A covariance can be
  /// singular.
  const std::vector<Gaussian<3>>& getGaussians() const { return gaussians_; }
  /// Returns the error of the last filter(): 95 % of the input lie within this distance of their output point [m]. With
  /// SplitRule::Shape, the distance is that from the plane through this point.
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
