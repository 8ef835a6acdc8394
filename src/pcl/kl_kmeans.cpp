// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/kl_kmeans.h"

#include <pcl/console/print.h>

#include <algorithm>
#include <exception>

namespace gaussmap {
namespace {

Gaussian<3> gaussianOf(const PointGaussian& point) {
  const auto& c = point.covariance;
  Gaussian<3> gaussian;
  gaussian.mean = point.getVector3fMap().cast<double>();
  gaussian.cov << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  gaussian.weight = static_cast<double>(point.weight);
  return gaussian;
}

void setMoments(PointGaussian& point, const Gaussian<3>& gaussian) {
  point.getVector3fMap() = gaussian.mean.cast<float>();
  int element = 0;
  for (int row = 0; row < 3; ++row)
    for (int column = row; column < 3; ++column)
      point.covariance[element++] = static_cast<float>(gaussian.cov(row, column));
  point.weight = static_cast<float>(gaussian.weight);
}

}  // namespace

void PointCloudKLKMeans::cluster(std::vector<pcl::PointIndices>& clusters) {
  clusters.clear();
  centres_.clear();
  result_ = {};
  if (!initCompute()) {
    PCL_ERROR("[gaussmap::PointCloudKLKMeans::cluster] no input cloud\n");
    return;
  }
  std::vector<Gaussian<3>> data;
  std::vector<pcl::index_t> index;
  for (const auto i : *indices_) {
    const Gaussian<3> gaussian = gaussianOf((*input_)[static_cast<std::size_t>(i)]);
    if (!gaussian.mean.allFinite() || !gaussian.cov.allFinite() || !std::isfinite(gaussian.weight)) continue;
    data.push_back(gaussian);
    index.push_back(i);
  }
  try {
    result_ = KLKMeans<3>(options_).fit(data);
  } catch (const std::exception& error) {
    PCL_ERROR("[gaussmap::PointCloudKLKMeans::cluster] %s\n", error.what());
    deinitCompute();
    return;
  }
  clusters.resize(result_.centres.size());
  for (pcl::PointIndices& cluster : clusters) cluster.header = input_->header;
  for (std::size_t i = 0; i < index.size(); ++i)
    clusters[static_cast<std::size_t>(result_.labels[i])].indices.push_back(index[i]);
  centres_.header = input_->header;
  centres_.sensor_origin_ = input_->sensor_origin_;
  centres_.sensor_orientation_ = input_->sensor_orientation_;
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    std::sort(clusters[k].indices.begin(), clusters[k].indices.end());
    PointGaussian centre = (*input_)[static_cast<std::size_t>(clusters[k].indices.front())];
    for (const auto i : clusters[k].indices) {
      const PointGaussian& member = (*input_)[static_cast<std::size_t>(i)];
      centre.occupancy = std::max(centre.occupancy, member.occupancy);
      centre.scale = std::max(centre.scale, member.scale);
      centre.cell_side = std::max(centre.cell_side, member.cell_side);
    }
    setMoments(centre, result_.centres[k]);
    centres_.push_back(centre);
  }
  deinitCompute();
}

}  // namespace gaussmap
