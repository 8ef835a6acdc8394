// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/search.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "gaussmap/pcl/conversions.h"
#include "map/map_means.h"
#include "map/map_origin.h"
#include "points/nearest_list.h"
#include "points/neighbour_tree.h"

namespace gaussmap {
namespace detail {

struct CloudSearch::Tree : NeighbourTree<float> {
  using NeighbourTree<float>::NeighbourTree;
};

namespace {

using CloudTree = NeighbourTree<float>;

bool isFinite(const float* point) {
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

/// Writes results as PCL returns them.
int writeResults(const std::vector<Neighbour<float, std::uint32_t>>& found, pcl::Indices& indices,
                 std::vector<float>& squares) {
  indices.resize(found.size());
  squares.resize(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    indices[i] = static_cast<pcl::index_t>(found[i].index);
    squares[i] = found[i].distance;
  }
  return static_cast<int>(found.size());
}

int findNothing(pcl::Indices& indices, std::vector<float>& squares) {
  indices.clear();
  squares.clear();
  return 0;
}

/// Returns the largest float that is not above the square of a radius.
float squareOf(double radius) {
  const double square = radius * radius;
  if (square > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::infinity();
  const auto rounded = static_cast<float>(square);
  return double{rounded} > square ? std::nextafter(rounded, 0.0f) : rounded;
}

}  // namespace

CloudSearch::CloudSearch(const PointsView& points, const pcl::Indices* indices) {
  std::vector<CloudTree::Point> finite;
  const auto add = [&](std::size_t i) {
    const float* const point = points[i];
    if (isFinite(point)) finite.push_back({{point[0], point[1], point[2]}, static_cast<std::uint32_t>(i)});
  };
  finite.reserve(indices ? indices->size() : points.count);
  if (indices)
    for (const auto i : *indices) add(static_cast<std::size_t>(i));
  else
    for (std::size_t i = 0; i < points.count; ++i) add(i);
  tree_ = std::make_shared<const Tree>(finite);
}

int CloudSearch::nearest(const float* point, int k, pcl::Indices& indices, std::vector<float>& squares) const {
  if (!tree_ || tree_->size() == 0 || k < 1 || !isFinite(point)) return findNothing(indices, squares);
  constexpr float kFar = std::numeric_limits<float>::infinity();
  if (k == 1) {
    NearestOne<float, std::uint32_t> one(kFar);
    tree_->search({point[0], point[1], point[2]}, one);
    indices.assign(1, static_cast<pcl::index_t>(one.best().index));
    squares.assign(1, one.best().distance);
    return 1;
  }
  NearestList<float, std::uint32_t> list(static_cast<std::size_t>(k), kFar);
  tree_->search({point[0], point[1], point[2]}, list);
  return writeResults(list.sort(), indices, squares);
}

int CloudSearch::within(const float* point, double radius, unsigned max_count, bool sorted, pcl::Indices& indices,
                        std::vector<float>& squares) const {
  if (!tree_ || tree_->size() == 0 || !(radius > 0.0) || !isFinite(point)) return findNothing(indices, squares);
  if (max_count > 0 && max_count < tree_->size()) {
    NearestList<float, std::uint32_t> list(max_count, squareOf(radius));
    tree_->search({point[0], point[1], point[2]}, list);
    return writeResults(list.sort(), indices, squares);
  }
  NeighboursWithin<float, std::uint32_t> list(squareOf(radius));
  tree_->search({point[0], point[1], point[2]}, list);
  return writeResults(sorted ? list.sort() : list.entries(), indices, squares);
}

MapMeans::MapMeans(const GaussianMapOctree& map, std::optional<int> scale)
    : ids(scale ? gaussiansOfScale(map, *scale) : leaves(map)), origin(mapOrigin(map)) {
  means.reserve(ids.size());
  for (const GaussianId& id : ids) {
    const Vector<3> centre = map.grid().centre(map.scale(id.scale).keys[map.cellOf(id.index, id.scale)], id.scale);
    means.emplace_back((centre - origin + localMean<3>(map, id.index, id.scale)).cast<float>());
  }
}

pcl::PointCloud<PointGaussian> MapMeans::gaussians(const GaussianMapOctree& map) const {
  pcl::PointCloud<PointGaussian> cloud, of_scale;
  cloud.reserve(ids.size());
  int scale = -1;
  for (const GaussianId& id : ids) {
    if (id.scale != scale) of_scale = toPointCloud(map, scale = id.scale);
    cloud.push_back(of_scale[id.index]);
  }
  return cloud;
}

}  // namespace detail

template class GaussianMapSearch<pcl::PointXYZ>;
template class GaussianMapSearch<pcl::PointXYZI>;
template class GaussianMapSearch<pcl::PointXYZRGB>;
template class GaussianMapSearch<pcl::PointNormal>;
template class GaussianMapSearch<pcl::PointXYZINormal>;
template class GaussianMapSearch<PointGaussian>;

}  // namespace gaussmap
