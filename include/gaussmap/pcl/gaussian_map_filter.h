// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/filters/filter.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/thin_points.h"
#include "gaussmap/points/split_points.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The points that GaussianMapFilter returns, one per Gaussian.
enum class FilterOutput {
  Means,   ///< the means of the Gaussians: closer to the input than samples, but not measured
  Samples  ///< the input points nearest to the means, so every output point was measured
};

/// How GaussianMapFilter groups the points.
enum class FilterMethod {
  Map,   ///< thinPoints(): sums the points in cells and merges near cells; gives a map
  Split  ///< splitPoints(): splits the cloud and moves points to the nearest mean; slower, gives no map
};

/// Options of GaussianMapFilter.
struct GaussianMapFilterOptions {
  /// Maximum number of points kept, >= 1. Without a value, it is 10,000 if neither an error nor a leaf size limits the
  /// number of points.
  std::optional<std::size_t> budget;
  /// If > 0: keeps as few points as possible so that 95 % of the input points lie within this distance [m] of their
  /// output points. If 0: keeps as many points as the budget allows.
  double max_error = 0.0;
  /// If > 0: side of the finest cells of the map [m], FilterMethod::Map only. Without a budget and an error, each
  /// occupied cell of `scale` gives one point, as with pcl::VoxelGrid. If 0: chosen from budget and error.
  double leaf_size = 0.0;
  int scale = 0;  ///< the cells of leaf_size * 2^scale are used, in [0, 19]; needs leaf_size
  FilterOutput output = FilterOutput::Means;  ///< means or samples
  FilterMethod method = FilterMethod::Map;    ///< how the points are grouped
  /// FilterMethod::Split only: how the output is distributed. SplitRule::Distance: every input point gets an output
  /// point nearby. SplitRule::Shape: few points on planes, many on curved surfaces. max_error is then the distance from
  /// the plane through the output point.
  SplitRule detail = SplitRule::Distance;
  int rounds = 3;   ///< FilterMethod::Split and SplitRule::Distance only: rounds of k-means after the splitting, >= 0
  int threads = 0;  ///< 0 = all cores; FilterMethod::Map uses them only for normals
};

/// Downsamples a cloud with a Gaussian map: to a maximum number of points, to an error limit, or to the Gaussians of a
/// scale. It is used like pcl::VoxelGrid, for any registered point type with x, y, z.
///
/// With FilterMethod::Map (default), the points are summed in the cells of a map, and near cells are merged (see
/// thinPoints()). getMap() returns the map.
///
/// Each output point represents one Gaussian, and each Gaussian represents some input points.
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
  /// Sets a distance [m]: 95 % of the input points must be at most this far from their output points. With 0, there is
  /// no such limit. If the distance cannot be kept, for example because setBudget() is too small, the filter prints a
  /// warning, and error() is larger than the distance.
  void setMaxError(double metres) { options_.max_error = metres; }
  /// Sets the side of the finest cells [m], as for pcl::VoxelGrid. See GaussianMapFilterOptions::leaf_size. 0:
  /// automatic.
  void setLeafSize(double metres) { options_.leaf_size = metres; }
  /// Sets the scale whose cells are used: 0 = cells of the leaf size, 1 = twice as wide, 2 = four times as wide ...
  void setScale(int scale) { options_.scale = scale; }
  /// Selects means or samples.
  void setOutput(FilterOutput output) { options_.output = output; }
  /// Selects how the points are grouped.
  void setMethod(FilterMethod method) { options_.method = method; }
  /// Selects FilterMethod::Split and how its output is distributed, see GaussianMapFilterOptions::detail.
  void setDetail(SplitRule detail) {
    options_.method = FilterMethod::Split;
    options_.detail = detail;
  }
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
  /// Returns the map of the last filter(), see ThinnedPoints::map(). Scale 0 has the cells with their exact moments,
  /// and scale 1 has the Gaussians of the output. Each call builds the map again. It is empty if FilterMethod::Split
  /// was used or if nothing was filtered.
  GaussianMapOctree getMap() const { return cells_.map(); }

 protected:
  void applyFilter(PointCloud& output) override;

 private:
  /// The groups of the points that are filtered. Labels and samples are indices of `points`.
  struct Groups {
    std::vector<std::int32_t> labels;
    std::vector<std::uint32_t> samples;
    bool error_kept = true;
  };
  /// Groups the points and sets gaussians_, error_ and cells_. Throws if an option is out of range.
  Groups group(const PointsView& points);

  GaussianMapFilterOptions options_;
  std::vector<std::int32_t> labels_;
  std::vector<Gaussian<3>> gaussians_;
  ThinnedPoints cells_;  // only the cells: the other results are moved out
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
