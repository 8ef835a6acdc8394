// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <memory>
#include <stdexcept>
#include <utility>

#include "gaussmap/core/pose.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What happens to points where the map has no cell.
enum class UnknownSpace {
  Keep,   ///< the points are kept, because nothing is known about the place
  Remove  ///< the points are removed: in an up-to-date map, a place without a cell is free
};

/// Options of DynamicPointsFilter.
struct DynamicPointsFilterOptions {
  /// Frame of the points. ScanFrame::Sensor: sensor_origin_ and sensor_orientation_ transform them into the map frame.
  ScanFrame frame = ScanFrame::Sensor;
  float threshold = 0.0f;                     ///< a place is free if its log-odds of occupancy are below this value
  UnknownSpace unknown = UnknownSpace::Keep;  ///< what happens to points where the map has no cell
};

/// Removes the points of moving objects. These are the points at places that a map marks as free by its occupancy.
///
/// Only a map of OnlineMapper has occupancy. A cell of a map of build() is never free, unless `threshold` is above 10.
/// Indices, setNegative(), removed indices, setKeepOrganized() and setUserFilterValue() work as in pcl::PassThrough.
/// Non-finite points are always removed. Any point type with x, y, z can be used. Without a map, or if the pose is not
/// valid, the filter prints an error and returns no points.
template <typename PointT>
class GAUSSMAP_API DynamicPointsFilter : public pcl::FilterIndices<PointT> {
 public:
  using Ptr = pcl::shared_ptr<DynamicPointsFilter>;              ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const DynamicPointsFilter>;   ///< shared pointer to const
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;  ///< shared pointer to the map

  /// Makes a filter without a map. `extract_removed_indices` enables getRemovedIndices().
  explicit DynamicPointsFilter(bool extract_removed_indices = false, const DynamicPointsFilterOptions& options = {})
      : pcl::FilterIndices<PointT>(extract_removed_indices), options_(options) {
    this->filter_name_ = "DynamicPointsFilter";
  }

  /// Sets the map. Its occupancy decides which places are free.
  void setMap(MapConstPtr map) { map_ = std::move(map); }
  /// Returns the map.
  const MapConstPtr& getMap() const { return map_; }
  /// Sets the frame of the points, see DynamicPointsFilterOptions.
  void setFrame(ScanFrame frame) { options_.frame = frame; }
  /// Sets the log-odds below which a place is free.
  void setThreshold(float log_odds) { options_.threshold = log_odds; }
  /// Sets what happens to points where the map has no cell.
  void setUnknownSpace(UnknownSpace unknown) { options_.unknown = unknown; }
  /// Returns the options.
  const DynamicPointsFilterOptions& options() const { return options_; }

 protected:
  using pcl::FilterIndices<PointT>::applyFilter;

  void applyFilter(pcl::Indices& indices) override {
    indices.clear();
    this->removed_indices_->clear();
    Pose pose;
    bool usable = map_ != nullptr;
    if (!usable) PCL_ERROR("[gaussmap::%s::filter] no map: call setMap()\n", this->getClassName().c_str());
    if (options_.frame == ScanFrame::Sensor) {
      pose.translation = this->input_->sensor_origin_.template head<3>().template cast<double>();
      pose.rotation = this->input_->sensor_orientation_.template cast<double>();
      if (const std::string fault = poseFault(pose); !fault.empty()) {
        PCL_ERROR("[gaussmap::%s::filter] %s\n", this->getClassName().c_str(), fault.c_str());
        usable = false;
      } else {
        pose = normalised(pose);
      }
    }
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    for (const auto index : *this->indices_) {
      const Vector<3> point = (*this->input_)[static_cast<std::size_t>(index)].getVector3fMap().template cast<double>();
      if (usable && point.allFinite() && isFree(rotation * point + pose.translation) == this->negative_)
        indices.push_back(index);
      else if (this->extract_removed_indices_)
        this->removed_indices_->push_back(index);
    }
  }

 private:
  bool isFree(const Vector<3>& point) const {
    const auto log_odds = logOddsAt<3>(*map_, point);
    return log_odds ? *log_odds < options_.threshold : options_.unknown == UnknownSpace::Remove;
  }

  DynamicPointsFilterOptions options_;
  MapConstPtr map_;
};

extern template class DynamicPointsFilter<pcl::PointXYZ>;
extern template class DynamicPointsFilter<pcl::PointXYZI>;
extern template class DynamicPointsFilter<pcl::PointXYZRGB>;
extern template class DynamicPointsFilter<pcl::PointNormal>;
extern template class DynamicPointsFilter<pcl::PointXYZINormal>;

}  // namespace gaussmap
