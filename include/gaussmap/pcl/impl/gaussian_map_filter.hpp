// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include "gaussmap/pcl/impl/field_means.hpp"
#include "gaussmap/points/normals.h"

namespace gaussmap {
namespace detail {

/// Normalises the normals of `to`. Points without a normal get one, and a curvature, from the surface of `from`.
template <typename PointT>
void fillNormals(const pcl::PointCloud<PointT>& from, int threads, pcl::PointCloud<PointT>& to) {
  std::vector<std::size_t> without;
  for (std::size_t i = 0; i < to.size(); ++i) {
    auto normal = to[i].getNormalVector3fMap();
    const float length = normal.norm();
    if (std::isfinite(length) && length > 1e-3f)
      normal /= length;
    else
      without.push_back(i);
  }
  if (without.empty()) return;
  std::vector<float> queries, found(4 * without.size());
  for (const std::size_t i : without) queries.insert(queries.end(), to[i].data, to[i].data + 3);
  PointNormalOptions options;
  options.viewpoint = from.sensor_origin_.template head<3>().template cast<double>();
  options.threads = threads;
  pointNormals({from[0].data, from.size(), sizeof(PointT) / sizeof(float)}, {queries.data(), without.size(), 3},
               {found.data(), found.data() + 3, 4}, options);
  for (std::size_t j = 0; j < without.size(); ++j) {
    PointT& point = to[without[j]];
    point.getNormalVector3fMap() = Eigen::Map<const Eigen::Vector3f>(found.data() + 4 * j);
    if constexpr (pcl::traits::has_curvature<PointT>::value) point.curvature = found[4 * j + 3];
  }
}

}  // namespace detail

template <typename PointT>
typename GaussianMapFilter<PointT>::Groups GaussianMapFilter<PointT>::group(const PointsView& points) {
  const PartPoint part_point = options_.output == FilterOutput::Means ? PartPoint::Mean : PartPoint::Sample;
  Groups groups;
  if (options_.method == FilterMethod::Map) {
    ThinPointsOptions options;
    options.max_gaussians = options_.budget;
    options.max_error = options_.max_error;
    options.leaf_size = options_.leaf_size;
    options.scale = options_.scale;
    options.part_point = part_point;
    cells_ = thinPoints(points, options);
    groups.labels = std::move(cells_.labels);
    groups.samples = std::move(cells_.samples);
    groups.error_kept = cells_.error_kept;
    gaussians_ = cells_.gaussians;
    error_ = cells_.error;
    return groups;
  }
  std::vector<Vector<3>> finite;
  std::vector<std::uint32_t> index;
  for (std::size_t i = 0; i < points.count; ++i) {
    const Eigen::Vector3f point(points[i][0], points[i][1], points[i][2]);
    if (!point.allFinite()) continue;
    finite.push_back(point.cast<double>());
    index.push_back(static_cast<std::uint32_t>(i));
  }
  SplitPointsOptions options;
  options.max_parts =
      options_.budget.value_or(options_.max_error > 0.0 ? std::max<std::size_t>(1, finite.size()) : options.max_parts);
  options.max_error = options_.max_error;
  options.rule = options_.detail;
  options.part_point = part_point;
  options.rounds = options_.rounds;
  options.threads = options_.threads;
  PointParts parts = splitPoints(finite, options);
  groups.labels.assign(points.count, -1);
  for (std::size_t i = 0; i < index.size(); ++i) groups.labels[index[i]] = static_cast<std::int32_t>(parts.labels[i]);
  for (const std::uint32_t sample : parts.samples) groups.samples.push_back(index[sample]);
  groups.error_kept = options_.max_error == 0.0 || parts.error <= options_.max_error;
  gaussians_ = std::move(parts.gaussians);
  error_ = parts.error;
  return groups;
}

template <typename PointT>
void GaussianMapFilter<PointT>::applyFilter(PointCloud& output) {
  const PointCloud& input = *this->input_;
  output.clear();
  output.is_dense = true;
  labels_.clear();
  gaussians_.clear();
  cells_ = ThinnedPoints();
  error_ = 0.0;
  this->removed_indices_->clear();

  // Without indices of the user, PCL selects all points. Otherwise the selected points are copied.
  const bool takes_all = this->fake_indices_;
  std::vector<std::array<float, 3>> selected;
  PointsView points{input.empty() ? nullptr : input[0].getVector3fMap().data(), input.size(),
                    sizeof(PointT) / sizeof(float)};
  if (!takes_all) {
    selected.reserve(this->indices_->size());
    for (const auto i : *this->indices_) {
      const float* const p = input[static_cast<std::size_t>(i)].getVector3fMap().data();
      selected.push_back({p[0], p[1], p[2]});
    }
    points = {selected.empty() ? nullptr : selected[0].data(), selected.size(), 3};
  }
  const auto inputIndex = [&](std::size_t i) { return takes_all ? i : static_cast<std::size_t>((*this->indices_)[i]); };

  Groups groups;
  try {
    groups = group(points);
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::%s::filter] %s\n", this->getClassName().c_str(), error.what());
    labels_.assign(input.size(), -1);
    return;
  }
  if (!groups.error_kept)
    PCL_WARN("[gaussmap::%s::filter] 95 %% of the points are within %g m, not within %g m: %s\n",
             this->getClassName().c_str(), error_, options_.max_error,
             options_.budget ? "raise the budget, or do not set one" : "the limit is too small for this cloud");

  output.reserve(groups.samples.size());
  for (const std::uint32_t sample : groups.samples) output.push_back(input[inputIndex(sample)]);
  if (this->extract_removed_indices_)  // first the points that are not finite, then the others
    for (const bool finite : {false, true})
      for (std::size_t i = 0; i < points.count; ++i) {
        const std::int32_t label = groups.labels[i];
        if ((label >= 0) != finite || (finite && groups.samples[static_cast<std::size_t>(label)] == i)) continue;
        this->removed_indices_->push_back(static_cast<pcl::index_t>(inputIndex(i)));
      }
  if (takes_all) {
    labels_ = std::move(groups.labels);
  } else {
    labels_.assign(input.size(), -1);
    for (std::size_t i = 0; i < points.count; ++i) labels_[inputIndex(i)] = groups.labels[i];
  }
  if (options_.output == FilterOutput::Means) {
    pcl::for_each_type<typename pcl::traits::fieldList<PointT>::type>(
        detail::FieldMeans<PointT>(input, labels_, output));
    for (std::size_t i = 0; i < output.size(); ++i)
      output[i].getVector3fMap() = gaussians_[i].mean.template cast<float>();
  }
  if constexpr (pcl::traits::has_normal<PointT>::value)
    if (!output.empty()) detail::fillNormals(input, options_.threads, output);
}

}  // namespace gaussmap
