// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/clustering/kl_kmeans.h"

namespace gaussmap {

/// One more cluster for a partition: Yguel 2009, Algorithm 2. K-means runs from the current references plus a seed at
/// the datum of largest distortion (ClusterSeed); then the swap loop takes a reference from where it is needed least
/// to the datum of largest distortion as long as that pays.
/// - `current_references` are the k - 1 clusters that there are; none = start with one cluster for all.
/// - The result has at most k clusters; no more than before if the data do not allow it (duplicates). Its distortion
///   never exceeds that of the current references. With k >= n each datum becomes its own cluster, distortion 0.
/// - options.k is not used. Data, references and errors as for KLKMeans.
template <int D>
KLClustering<D> insertCluster(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& current_references,
                              const KLKMeansOptions& options = {});

}  // namespace gaussmap
