// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/for_each_type.h>
#include <pcl/point_cloud.h>
#include <pcl/register_point_struct.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace gaussmap::detail {

/// Averages the fields of a cloud's points per part, for use with pcl::for_each_type. Does not change x, y, z and
/// label.
template <typename PointT>
class FieldMeans {
 public:
  /// `from`: the input points; `labels` gives the part of each, or -1. `to`: one point per part.
  FieldMeans(const pcl::PointCloud<PointT>& from, const std::vector<std::int32_t>& labels, pcl::PointCloud<PointT>& to)
      : from_(from), labels_(labels), to_(to) {}

  /// Averages one field, unless it is x, y, z or label.
  template <typename Field>
  void operator()() const {
    using Type = typename pcl::traits::datatype<PointT, Field>::type;
    const std::string name = pcl::traits::name<PointT, Field>::value;
    if (name == "x" || name == "y" || name == "z" || name == "label") return;
    constexpr std::size_t offset = pcl::traits::offset<PointT, Field>::value;
    if (name == "rgb" || name == "rgba") return average<std::uint8_t, 4>(offset);
    using Scalar = std::remove_all_extents_t<Type>;
    average<Scalar, sizeof(Type) / sizeof(Scalar)>(offset);
  }

 private:
  template <typename Scalar, std::size_t kCount>
  void average(std::size_t offset) const {
    std::vector<std::array<double, kCount>> sums(to_.size(), std::array<double, kCount>{});
    std::vector<std::array<double, kCount>> counts = sums;
    for (std::size_t i = 0; i < from_.size(); ++i) {
      if (labels_[i] < 0) continue;
      const auto part = static_cast<std::size_t>(labels_[i]);
      std::array<Scalar, kCount> values;
      std::memcpy(values.data(), reinterpret_cast<const std::uint8_t*>(&from_[i]) + offset, sizeof(values));
      for (std::size_t k = 0; k < kCount; ++k) {
        const auto value = static_cast<double>(values[k]);
        if (!std::isfinite(value)) continue;
        sums[part][k] += value;
        counts[part][k] += 1.0;
      }
    }
    for (std::size_t part = 0; part < to_.size(); ++part) {
      std::array<Scalar, kCount> means;
      for (std::size_t k = 0; k < kCount; ++k) {
        const double mean = sums[part][k] / counts[part][k];  // NaN if no value is finite
        if constexpr (std::is_integral_v<Scalar>)
          means[k] = static_cast<Scalar>(std::lround(mean));
        else
          means[k] = static_cast<Scalar>(mean);
      }
      std::memcpy(reinterpret_cast<std::uint8_t*>(&to_[part]) + offset, means.data(), sizeof(means));
    }
  }

  const pcl::PointCloud<PointT>& from_;
  const std::vector<std::int32_t>& labels_;
  pcl::PointCloud<PointT>& to_;
};

}  // namespace gaussmap::detail
