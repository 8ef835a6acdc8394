// SPDX-License-Identifier: BSD-3-Clause
// Runs a class of gaussmap and the class of PCL beside it with the same calls. The tests are in plug_in_situations.h.
#pragma once

#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/octree/octree_pointcloud_pointvector.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/filters/impl/passthrough.hpp>
#include <pcl/segmentation/impl/extract_clusters.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "gaussmap/pcl/conversions.h"
#include "gaussmap/pcl/dynamic_points_filter.h"
#include "gaussmap/pcl/gaussian_map_filter.h"
#include "gaussmap/pcl/kl_kmeans.h"
#include "gaussmap/pcl/map_builder.h"
#include "gaussmap/pcl/normal_estimation.h"
#include "gaussmap/pcl/online_mapper.h"
#include "gaussmap/pcl/registration.h"
#include "gaussmap/pcl/search.h"
#include "gaussmap/pcl/segment_fitter.h"
#include "map/inherit_occupancy.h"

namespace gaussmap::test {

/// What a user sets. Without a cloud, the setter is not called.
template <typename PointT>
struct Input {
  typename pcl::PointCloud<PointT>::Ptr cloud;
  pcl::IndicesPtr indices;

  template <typename Class>
  void setTo(Class& each) const {
    if (cloud) each.setInputCloud(cloud);
    if (indices) each.setIndices(indices);
  }
};

/// What a class returns, whatever it is.
struct Outcome {
  std::size_t count = 0;                             // points, normals, points in a map or in clusters
  std::vector<Eigen::Vector3f> values;               // points or normals, empty for a map
  Eigen::Vector3f motion = Eigen::Vector3f::Zero();  // of a registration
  std::uint32_t width = 0, height = 0;
  bool is_dense = true;
  bool converged = true;
  std::string frame_id;
  std::string printed;  // on stderr
};

/// Calls `run` and returns its outcome and what it has printed.
template <typename Run>
Outcome outcomeOf(const Run& run) {
  testing::internal::CaptureStderr();
  Outcome outcome;
  run(outcome);
  outcome.printed = testing::internal::GetCapturedStderr();
  return outcome;
}

template <typename PointT>
void takeCloud(const pcl::PointCloud<PointT>& cloud, Outcome& outcome) {
  outcome.count = cloud.size();
  outcome.width = cloud.width;
  outcome.height = cloud.height;
  outcome.is_dense = cloud.is_dense;
  outcome.frame_id = cloud.header.frame_id;
  for (const PointT& point : cloud) outcome.values.push_back(point.getVector3fMap());
}

/// An organised cloud: a room of 8 m x 6 m x 3 m as a lidar in its middle sees it, 25 rings of 180 points. The middle
/// ring is horizontal. `shift` moves the room along x.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr roomCloud(float shift = 0.0f) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>(180, 25);
  Random random(5);
  for (int ring = 0; ring < 25; ++ring)
    for (int column = 0; column < 180; ++column) {
      const double elevation = (ring - 12) * 3.0 * M_PI / 180.0, azimuth = (column + 0.5) * 2.0 * M_PI / 180.0;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
      const double range =
          std::min({4.0 / std::abs(ray.x()), 3.0 / std::abs(ray.y()), 1.5 / std::max(1e-9, std::abs(ray.z()))}) +
          0.002 * random.normal();
      PointT& point = cloud->at(column, ring);
      point = PointT{};
      point.getVector3fMap() = (range * ray).template cast<float>();
      point.x += shift;
    }
  cloud->header.frame_id = "room";
  return cloud;
}

/// Means of a filter: GaussianMapFilter and pcl::VoxelGrid.
template <typename PointT>
struct Thinning {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = false;
  template <typename Filter>
  static Outcome run(Filter& filter, const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      input.setTo(filter);
      pcl::PointCloud<PointT> output;
      filter.filter(output);
      takeCloud(output, outcome);
    });
  }
  static Outcome ours(const Input<PointT>& input) {
    GaussianMapFilter<PointT> filter;
    filter.setBudget(200);
    return run(filter, input);
  }
  static Outcome ofPcl(const Input<PointT>& input) {
    pcl::VoxelGrid<PointT> filter;
    filter.setLeafSize(0.8f, 0.8f, 0.8f);
    return run(filter, input);
  }
};

/// DynamicPointsFilter with a map that is free at x < 0, and pcl::PassThrough with x >= 0.
template <typename PointT>
struct Selection {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = false;
  static Outcome ours(const Input<PointT>& input) {
    static const auto map = [] {
      const GaussianMapOctree room = buildMap(*roomCloud<PointT>(), {0.5, 10, 2, 0.0});
      std::vector<float> log_odds;
      for (std::size_t i = 0; i < room.gaussianCount(0); ++i)
        log_odds.push_back(room.gaussian(i, 0).mean.x() < 0.0 ? -1.0f : 1.0f);
      return std::make_shared<const GaussianMapOctree>(gaussmap::detail::withOccupancy<3>(room, log_odds));
    }();
    DynamicPointsFilter<PointT> filter;
    filter.setMap(map);
    return Thinning<PointT>::run(filter, input);
  }
  static Outcome ofPcl(const Input<PointT>& input) {
    pcl::PassThrough<PointT> filter;
    filter.setFilterFieldName("x");
    filter.setFilterLimits(0.0f, 1e9f);
    return Thinning<PointT>::run(filter, input);
  }
};

/// CellNormalEstimation and pcl::NormalEstimation.
template <typename PointT>
struct Normals {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = true;
  template <typename Estimation>
  static Outcome run(Estimation& estimation, const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      input.setTo(estimation);
      estimation.setKSearch(12);
      pcl::PointCloud<pcl::Normal> output;
      estimation.compute(output);
      takeNormals(output, outcome);
    });
  }
  static void takeNormals(const pcl::PointCloud<pcl::Normal>& output, Outcome& outcome) {
    outcome.width = output.width;
    outcome.height = output.height;
    outcome.is_dense = output.is_dense;
    outcome.frame_id = output.header.frame_id;
    for (const pcl::Normal& normal : output) {
      outcome.values.emplace_back(normal.normal_x, normal.normal_y, normal.normal_z);
      outcome.count += outcome.values.back().allFinite() ? 1 : 0;
    }
  }
  static Outcome ours(const Input<PointT>& input) {
    CellNormalEstimation<PointT> estimation;
    if (input.cloud) estimation.setSearchSurface(input.cloud);
    return run(estimation, input);
  }
  static Outcome ofPcl(const Input<PointT>& input) {
    pcl::NormalEstimation<PointT, pcl::Normal> estimation;
    if (input.cloud) estimation.setSearchSurface(input.cloud);
    return run(estimation, input);
  }
};

/// GaussianMapRegistration and a registration of PCL. The target is the room, 10 cm away along x. PCL's own classes
/// return the whole cloud, also after setIndices(); ours returns the selected points, as pcl::Registration says.
template <typename PointT, template <typename, typename, typename> class OfPcl>
struct Registrations {
  using Point = PointT;
  // With NaN in the source, PCL's own registrations search the neighbours of NaN, which their kd-tree does not allow.
  static constexpr bool kPclTakesNan = false, kPclTakesIndices = false, kKeepsRows = true;
  template <typename Registration>
  static Outcome run(const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      Registration registration;
      registration.setInputTarget(roomCloud<PointT>(0.1f));
      if (input.cloud) registration.setInputSource(input.cloud);
      if (input.indices) registration.setIndices(input.indices);
      pcl::PointCloud<PointT> output;
      registration.align(output);
      takeCloud(output, outcome);
      outcome.motion = registration.getFinalTransformation().template topRightCorner<3, 1>();
      outcome.converged = registration.hasConverged();
    });
  }
  static Outcome ours(const Input<PointT>& input) { return run<GaussianMapRegistration<PointT, PointT>>(input); }
  static Outcome ofPcl(const Input<PointT>& input) { return run<OfPcl<PointT, PointT, float>>(input); }
};

/// Number of points in an octree of PCL.
template <typename PointT>
Outcome octreeOfPcl(const Input<PointT>& input) {
  return outcomeOf([&](Outcome& outcome) {
    pcl::octree::OctreePointCloudPointVector<PointT> octree(0.2);
    if (!input.cloud) return;  // PCL's octree would read through the null pointer
    octree.setInputCloud(input.cloud, input.indices);
    octree.addPointsFromInputCloud();
    for (auto leaf = octree.leaf_depth_begin(); leaf != octree.leaf_depth_end(); ++leaf)
      outcome.count += leaf.getLeafContainer().getSize();
  });
}

/// GaussianMapSearch and pcl::search::KdTree: the points that they find near some places.
template <typename PointT>
struct Searching {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = false;
  static Outcome run(pcl::search::Search<PointT>& search, const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      search.setInputCloud(input.cloud, input.indices);
      for (const Eigen::Vector3f& place :
           {Eigen::Vector3f(4, 0, 0), Eigen::Vector3f(-1, 3, 1), Eigen::Vector3f(9, 9, 9)}) {
        PointT query{};
        query.getVector3fMap() = place;
        pcl::Indices found;
        std::vector<float> squares;
        const auto take = [&](int count) {
          outcome.count += static_cast<std::size_t>(count);
          for (const auto index : found)
            outcome.values.push_back((*input.cloud)[static_cast<std::size_t>(index)].getVector3fMap());
        };
        take(search.nearestKSearch(query, 30, found, squares));
        take(search.radiusSearch(query, 1.5, found, squares));
      }
    });
  }
  static Outcome ours(const Input<PointT>& input) {
    GaussianMapSearch<PointT> search;
    return run(search, input);
  }
  static Outcome ofPcl(const Input<PointT>& input) {
    if (!input.cloud || input.cloud->empty()) return {};  // PCL's tree would read through a null pointer
    pcl::search::KdTree<PointT> search;
    return run(search, input);
  }
};

/// PointCloudMapBuilder and pcl::octree::OctreePointCloud.
template <typename PointT>
struct Building {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = false;
  static Outcome ours(const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      PointCloudMapBuilder<PointT> builder({0.2, 5, 2, 0.0});
      input.setTo(builder);
      builder.addPointsFromInputCloud();
      outcome.count = static_cast<std::size_t>(builder.getMap()->weight(0));
    });
  }
  static Outcome ofPcl(const Input<PointT>& input) { return octreeOfPcl(input); }
};

/// PointCloudOnlineMapper and pcl::octree::OctreePointCloud.
template <typename PointT>
struct OnlineMapping {
  using Point = PointT;
  static constexpr bool kPclTakesNan = true, kPclTakesIndices = true, kKeepsRows = false;
  static Outcome ours(const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      PointCloudOnlineMapper<PointT> mapper;
      mapper.setResolution(0.2);
      input.setTo(mapper);
      mapper.update();
      outcome.count = static_cast<std::size_t>(mapper.getMap()->weight(0));
    });
  }
  static Outcome ofPcl(const Input<PointT>& input) { return octreeOfPcl(input); }
};

inline std::size_t membersOf(const std::vector<pcl::PointIndices>& clusters, const std::string& frame_id,
                             Outcome& outcome) {
  std::size_t members = 0;
  for (const pcl::PointIndices& cluster : clusters) {
    members += cluster.indices.size();
    EXPECT_EQ(cluster.header.frame_id, frame_id);
  }
  outcome.frame_id = clusters.empty() ? "" : clusters[0].header.frame_id;
  return members;
}

template <typename PointT>
Outcome clustersOfPcl(const Input<PointT>& input) {
  return outcomeOf([&](Outcome& outcome) {
    pcl::EuclideanClusterExtraction<PointT> clustering;
    input.setTo(clustering);
    clustering.setClusterTolerance(1.0);
    std::vector<pcl::PointIndices> clusters;
    clustering.extract(clusters);
    outcome.count = membersOf(clusters, "room", outcome);
  });
}

/// PointCloudKLKMeans and pcl::EuclideanClusterExtraction, on Gaussians at the points.
template <typename PointT>
struct Clustering {
  using Point = PointT;
  static constexpr bool kPclTakesNan = false, kPclTakesIndices = true,
                        kKeepsRows = false;  // searches the neighbours of NaN
  static Input<PointGaussian> gaussiansAt(const Input<PointT>& input) {
    if (!input.cloud) return {nullptr, input.indices};
    auto gaussians = pcl::make_shared<pcl::PointCloud<PointGaussian>>(input.cloud->width, input.cloud->height);
    gaussians->header = input.cloud->header;
    gaussians->is_dense = input.cloud->is_dense;
    for (std::size_t i = 0; i < input.cloud->size(); ++i) {
      PointGaussian& gaussian = (*gaussians)[i];
      gaussian = PointGaussian{};
      gaussian.getVector3fMap() = (*input.cloud)[i].getVector3fMap();
      gaussian.covariance[0] = gaussian.covariance[3] = gaussian.covariance[5] = 0.01f;
      gaussian.weight = 1.0f;
    }
    return {gaussians, input.indices};
  }
  static Outcome ours(const Input<PointT>& input) {
    const Input<PointGaussian> gaussians = gaussiansAt(input);
    return outcomeOf([&](Outcome& outcome) {
      PointCloudKLKMeans clustering;
      gaussians.setTo(clustering);
      clustering.setNumberOfClusters(4);
      std::vector<pcl::PointIndices> clusters;
      clustering.cluster(clusters);
      outcome.count = membersOf(clusters, "room", outcome);
    });
  }
  static Outcome ofPcl(const Input<PointT>& input) { return clustersOfPcl(gaussiansAt(input)); }
};

/// PointCloudSegmentFitter, on the horizontal ring, and pcl::EuclideanClusterExtraction.
template <typename PointT>
struct Segments {
  using Point = PointT;
  static constexpr bool kPclTakesNan = false, kPclTakesIndices = true,
                        kKeepsRows = false;  // searches the neighbours of NaN
  static Outcome ours(const Input<PointT>& input) {
    return outcomeOf([&](Outcome& outcome) {
      PlanarScanOptions planar;
      planar.slice = true;
      planar.z_min = -0.05;
      planar.z_max = 0.05;
      PointCloudSegmentFitter<PointT> fitter;
      fitter.setPlanarScan(planar);
      input.setTo(fitter);
      fitter.fit();
      std::vector<pcl::PointIndices> segments;
      fitter.segmentIndices(segments);
      outcome.count = membersOf(segments, "room", outcome);
    });
  }
  static Outcome ofPcl(const Input<PointT>& input) { return clustersOfPcl(input); }
};

}  // namespace gaussmap::test
