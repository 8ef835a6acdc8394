// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/point_types.h>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

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
void GaussianMapFilter<PointT>::applyFilter(PointCloud& output) {
  const PointCloud& input = *this->input_;
  output.clear();
  output.is_dense = true;
  labels_.assign(input.size(), -1);
  gaussians_.clear();
  error_ = 0.0;
  this->removed_indices_->clear();
  std::vector<Vector<3>> points;
  std::vector<std::uint32_t> index;
  for (const auto i : *this->indices_) {
    const Eigen::Vector3f point = input[static_cast<std::size_t>(i)].getVector3fMap();
    if (!point.allFinite()) {
      if (this->extract_removed_indices_) this->removed_indices_->push_back(i);
      continue;
    }
    points.push_back(point.template cast<double>());
    index.push_back(static_cast<std::uint32_t>(i));
  }

  PointParts parts;
  try {
    SplitPointsOptions options;
    options.max_parts = options_.budget;
    options.max_error = options_.max_error;
    options.rule = options_.detail;
    options.part_point = options_.output == FilterOutput::Means ? PartPoint::Mean : PartPoint::Sample;
    options.rounds = options_.rounds;
    options.threads = options_.threads;
    parts = splitPoints(points, options);
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::%s::filter] %s\n", this->getClassName().c_str(), error.what());
    return;
  }

  for (const std::uint32_t sample : parts.samples) output.push_back(input[index[sample]]);
  for (std::size_t i = 0; i < index.size(); ++i) labels_[index[i]] = static_cast<std::int32_t>(parts.labels[i]);
  if (options_.output == FilterOutput::Means) {
    pcl::for_each_type<typename pcl::traits::fieldList<PointT>::type>(
        detail::FieldMeans<PointT>(input, labels_, output));
    for (std::size_t part = 0; part < output.size(); ++part)
      output[part].getVector3fMap() = parts.gaussians[part].mean.template cast<float>();
  }
  if constexpr (pcl::traits::has_normal<PointT>::value)
    if (!output.empty()) detail::fillNormals(input, options_.threads, output);
  if (this->extract_removed_indices_)
    for (std::size_t i = 0; i < index.size(); ++i)
      if (parts.samples[parts.labels[i]] != i) this->removed_indices_->push_back(static_cast<pcl::index_t>(index[i]));
  gaussians_ = std::move(parts.gaussians);
  error_ = parts.error;
}

}  // namespace gaussmap
