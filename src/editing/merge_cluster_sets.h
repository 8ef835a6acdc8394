// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "editing/map_pair.h"
#include "gaussmap/editing/merge_maps.h"

namespace gaussmap::detail {

/// Agglomerates the Gaussians of a cell of scale s until `parts` clusters are left. `areas` = their areas, in any unit.
/// With MergeMapsOptions::smooth, one run of KLKMeans follows. Returns the cluster of each Gaussian, in [0, parts); the
/// run can drop clusters.
template <int D>
std::vector<int> unitedLabels(const std::vector<SourceGaussian<D>>& sources, const std::vector<double>& areas,
                              std::size_t parts, double finest_side, const MergeMapsOptions& options);

/// Returns the moment matches of the clusters of these Gaussians. `label` = labels 0, 1, ... of which none is missing.
template <int D>
std::vector<Gaussian<D>> unionsOf(const std::vector<SourceGaussian<D>>& sources, const std::vector<int>& label);

/// MergeMethod::Clusters, Yguel 2009 sec. 5.4: merges the clusters of the two maps at every scale.
template <int D>
GaussianMap<D> mergeClusterSets(const MapPair<D>& maps, const MergeMapsOptions& options);

}  // namespace gaussmap::detail
