// SPDX-License-Identifier: BSD-3-Clause
// Compiles PCL's common class templates for PointGaussian. The libraries of PCL contain them only for PCL's own point
// types. Without this file, a program that uses one of them with PointGaussian would have to define PCL_NO_PRECOMPILE
// before the first header of PCL. The headers of PCL only declare the functions of these templates, so the linker finds
// the code here, whatever the order of the headers.
#include <pcl/octree/octree_pointcloud.h>
#include <pcl/octree/octree_pointcloud_changedetector.h>
#include <pcl/octree/octree_pointcloud_density.h>
#include <pcl/octree/octree_pointcloud_occupancy.h>
#include <pcl/octree/octree_pointcloud_pointvector.h>
#include <pcl/octree/octree_pointcloud_singlepoint.h>
#include <pcl/octree/octree_search.h>
#include <pcl/search/octree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/filters/impl/conditional_removal.hpp>
#include <pcl/filters/impl/crop_box.hpp>
#include <pcl/filters/impl/extract_indices.hpp>
#include <pcl/filters/impl/filter.hpp>
#include <pcl/filters/impl/filter_indices.hpp>
#include <pcl/filters/impl/passthrough.hpp>
#include <pcl/filters/impl/radius_outlier_removal.hpp>
#include <pcl/filters/impl/random_sample.hpp>
#include <pcl/filters/impl/statistical_outlier_removal.hpp>
#include <pcl/filters/impl/uniform_sampling.hpp>
#include <pcl/filters/impl/voxel_grid.hpp>
#include <pcl/impl/pcl_base.hpp>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/octree/impl/octree_base.hpp>
#include <pcl/octree/impl/octree_pointcloud.hpp>
#include <pcl/octree/impl/octree_search.hpp>
#include <pcl/search/impl/brute_force.hpp>
#include <pcl/search/impl/kdtree.hpp>
#include <pcl/search/impl/organized.hpp>
#include <pcl/search/impl/search.hpp>
#include <pcl/segmentation/impl/extract_clusters.hpp>

#include "gaussmap/pcl/point_gaussian.h"

namespace pcl {

using gaussmap::PointGaussian;

template class PCLBase<PointGaussian>;

template class Filter<PointGaussian>;
template class FilterIndices<PointGaussian>;
template class ConditionalRemoval<PointGaussian>;
template class ConditionBase<PointGaussian>;
template class ConditionAnd<PointGaussian>;
template class ConditionOr<PointGaussian>;
template class FieldComparison<PointGaussian>;
template class CropBox<PointGaussian>;
template class ExtractIndices<PointGaussian>;
template class PassThrough<PointGaussian>;
template class RadiusOutlierRemoval<PointGaussian>;
template class RandomSample<PointGaussian>;
template class StatisticalOutlierRemoval<PointGaussian>;
template class UniformSampling<PointGaussian>;
template class VoxelGrid<PointGaussian>;
template void removeNaNFromPointCloud(const PointCloud<PointGaussian>&, PointCloud<PointGaussian>&, Indices&);
template void removeNaNFromPointCloud(const PointCloud<PointGaussian>&, Indices&);

template class KdTreeFLANN<PointGaussian>;
namespace search {
template class Search<PointGaussian>;
template class BruteForce<PointGaussian>;
template class KdTree<PointGaussian>;
template class Octree<PointGaussian>;
template class OrganizedNeighbor<PointGaussian>;
}  // namespace search
template class EuclideanClusterExtraction<PointGaussian>;

namespace octree {
template class OctreePointCloud<PointGaussian>;
template class OctreePointCloudSearch<PointGaussian>;
template class OctreePointCloudPointVector<PointGaussian>;
template class OctreePointCloudSinglePoint<PointGaussian>;
template class OctreePointCloudOccupancy<PointGaussian>;
template class OctreePointCloudDensity<PointGaussian>;
template class OctreePointCloudChangeDetector<PointGaussian>;
}  // namespace octree

}  // namespace pcl
