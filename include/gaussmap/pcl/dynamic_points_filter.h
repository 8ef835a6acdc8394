// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/filters/filter_indices.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/impl/pcl_base.hpp>  // a user's own point type has no other

#include <memory>
#include <stdexcept>
#include <utility>

#include "gaussmap/core/pose.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What becomes of points where the map has no cell.
enum class UnknownSpace {
  Keep,   ///< nothing is known of them
  Remove  ///< a map that is kept up to date has cells wherever something stands: what it has forgotten is free
};

struct DynamicPointsFilterOptions {
  ScanFrame frame = ScanFrame::Sensor;  ///< of the points; Sensor: sensor_origin_ and sensor_orientation_ move them
  float threshold = 0.0f;               ///< a place with log-odds of occupancy below it is free
  UnknownSpace unknown = UnknownSpace::Keep;
};

/// Removes the points of moving objects: those at places that a map's occupancy calls free (OnlineMapper,
/// withOccupancy(); a map that was made in one go calls nothing free). Indices, setNegative(), removed indices,
/// setKeepOrganized() and setUserFilterValue() are as in pcl::PassThrough; points that are not finite are removed
/// either way. Any point type with x, y, z. Without a map, or with a pose that is none, an error is printed and nothing
/// passes.
template <typename PointT>
class GAUSSMAP_API DynamicPointsFilter : public pcl::FilterIndices<PointT> {
 public:
  using Ptr = pcl::shared_ptr<DynamicPointsFilter>;
  using ConstPtr = pcl::shared_ptr<const DynamicPointsFilter>;
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;

  explicit DynamicPointsFilter(bool extract_removed_indices = false, const DynamicPointsFilterOptions& options = {})
      : pcl::FilterIndices<PointT>(extract_removed_indices), options_(options) {
    this->filter_name_ = "DynamicPointsFilter";
  }

  void setMap(MapConstPtr map) { map_ = std::move(map); }
  const MapConstPtr& getMap() const { return map_; }
  void setFrame(ScanFrame frame) { options_.frame = frame; }
  void setThreshold(float log_odds) { options_.threshold = log_odds; }
  void setUnknownSpace(UnknownSpace unknown) { options_.unknown = unknown; }
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
