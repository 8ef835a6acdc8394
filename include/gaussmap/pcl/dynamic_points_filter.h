// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <exception>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "gaussmap/pcl/impl/sensor_pose.hpp"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of DynamicPointsFilter.
struct DynamicPointsFilterOptions {
  /// Frame of the points. ScanFrame::Sensor: sensor_origin_ and sensor_orientation_ transform them into the map frame.
  /// ScanFrame::Map: the points are in the map frame, and sensor_origin_ is used only by UnknownSpace::Automatic.
  ScanFrame frame = ScanFrame::Sensor;
  float threshold = 0.0f;  ///< a place is free if its log-odds of occupancy are below this value
  UnknownSpace unknown = UnknownSpace::Automatic;  ///< what is assumed of places without a cell
  VisibilityOptions visibility;  ///< UnknownSpace::Automatic: how clearly a surface must lie behind a free place
  int threads = 0;               ///< 0 = all cores
};

/// Removes the points of moving objects: those at places that are free in a map, see freePoints().
///
/// A map of OnlineMapper forgets moving objects, so there are no cells at their places. By default, a point without a
/// cell is removed if the map has a surface clearly behind it, as seen from the sensor, or if it is connected to such
/// points. Other points without a cell are kept, because the map may not have seen their places. A map of build() has
/// no occupancy, so its cells are never free, unless `threshold` is above kMaxOccupancy.
///
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

  /// Sets the map. Prints a warning if the map has no occupancy, because its cells are then never free. Such a map
  /// still contains all moving objects of its scans, unless their points were removed before it was built.
  void setMap(MapConstPtr map) {
    map_ = std::move(map);
    if (map_ && !map_->empty() && !map_->hasOccupancy())
      PCL_WARN(
          "[gaussmap::%s::setMap] the map has no occupancy, so no point in its cells is removed: make it with "
          "OnlineMapper or 'gaussmap pcd2map --online'\n",
          this->getClassName().c_str());
  }
  /// Returns the map.
  const MapConstPtr& getMap() const { return map_; }
  /// Sets the frame of the points, see DynamicPointsFilterOptions.
  void setFrame(ScanFrame frame) { options_.frame = frame; }
  /// Sets the log-odds below which a place is free.
  void setThreshold(float log_odds) { options_.threshold = log_odds; }
  /// Sets what is assumed of places where the map has no cell.
  void setUnknownSpace(UnknownSpace unknown) { options_.unknown = unknown; }
  /// Sets the number of threads; 0 = all cores.
  void setNumberOfThreads(int threads) { options_.threads = threads; }
  /// Returns the options.
  const DynamicPointsFilterOptions& options() const { return options_; }

 protected:
  using pcl::FilterIndices<PointT>::applyFilter;

  void applyFilter(pcl::Indices& indices) override {
    indices.clear();
    this->removed_indices_->clear();
    std::vector<bool> free;
    const bool usable = findFree(free);
    for (std::size_t i = 0; i < this->indices_->size(); ++i) {
      const auto index = (*this->indices_)[i];
      const bool finite = (*this->input_)[static_cast<std::size_t>(index)].getVector3fMap().allFinite();
      if (usable && finite && free[i] == this->negative_)
        indices.push_back(index);
      else if (this->extract_removed_indices_)
        this->removed_indices_->push_back(index);
    }
  }

 private:
  /// Fills `free` with one flag per selected point. Prints an error and returns false if there is no map or no valid
  /// pose.
  bool findFree(std::vector<bool>& free) const {
    try {
      if (!map_) throw std::invalid_argument("no map: call setMap()");
      Pose pose;
      pose.translation = this->input_->sensor_origin_.template head<3>().template cast<double>();
      const Eigen::Vector3d sensor = pose.translation;
      if (options_.frame == ScanFrame::Map)
        pose = Pose();
      else
        pose = detail::sensorPose(*this->input_);
      const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
      std::vector<Eigen::Vector3d> points;
      points.reserve(this->indices_->size());
      for (const auto index : *this->indices_) {
        const auto& point = (*this->input_)[static_cast<std::size_t>(index)];
        points.push_back(rotation * point.getVector3fMap().template cast<double>() + pose.translation);
      }
      free = freePoints(*map_, points, sensor,
                        {options_.threshold, options_.unknown, options_.visibility, options_.threads});
      return true;
    } catch (const std::exception& error) {
      PCL_ERROR("[gaussmap::%s::filter] %s\n", this->getClassName().c_str(), error.what());
      return false;
    }
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
