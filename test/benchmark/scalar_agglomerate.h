// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "gaussmap/clustering/agglomerate.h"

namespace gaussmap::refinement {

/// Agglomeration in simple code. Clusters are Eigen objects. Runnalls' cost is computed pair by pair, with its
/// logarithm. Every cluster stores the cheapest partner behind it, and searches again when the partner is gone or has
/// changed.
inline Dendrogram scalarAgglomerate(const std::vector<Gaussian<3>>& data) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Cluster {
    Gaussian<3> gaussian;
    double log_det = 0.0;
    std::uint32_t node = 0;
    bool live = true;
    double least = kInfinity;
    std::size_t partner = 0;
  };
  const auto unite = [](const Gaussian<3>& a, const Gaussian<3>& b) {
    const double sum = a.weight + b.weight;
    const Vector<3> apart = a.mean - b.mean;
    return Gaussian<3>{
        (a.weight * a.mean + b.weight * b.mean) / sum,
        (a.weight * a.cov + b.weight * b.cov) / sum + (a.weight * b.weight / (sum * sum)) * apart * apart.transpose(),
        sum};
  };
  const auto cost = [&](const Cluster& a, const Cluster& b) {
    const Gaussian<3> both = unite(a.gaussian, b.gaussian);
    return 0.5 * (both.weight * std::log(both.cov.determinant()) - a.gaussian.weight * a.log_det -
                  b.gaussian.weight * b.log_det);
  };

  std::vector<Cluster> clusters(data.size());
  const auto findPartner = [&](std::size_t i) {
    clusters[i].least = kInfinity;
    for (std::size_t j = i + 1; j < clusters.size(); ++j) {
      if (!clusters[j].live) continue;
      const double value = cost(clusters[i], clusters[j]);
      if (value < clusters[i].least) {
        clusters[i].least = value;
        clusters[i].partner = j;
      }
    }
  };
  for (std::size_t i = 0; i < data.size(); ++i) {
    clusters[i].gaussian = data[i];
    clusters[i].log_det = std::log(data[i].cov.determinant());
    clusters[i].node = static_cast<std::uint32_t>(i);
  }
  for (std::size_t i = 0; i < data.size(); ++i) findPartner(i);

  Dendrogram dendrogram{data.size(), {}};
  while (dendrogram.merges.size() + 1 < data.size()) {
    std::size_t a = 0;
    for (std::size_t i = 0; i < clusters.size(); ++i)
      if (clusters[i].live && clusters[i].least < clusters[a].least) a = i;
    const std::size_t b = clusters[a].partner;
    dendrogram.merges.push_back({clusters[a].node, clusters[b].node, clusters[a].least});
    clusters[a].gaussian = unite(clusters[a].gaussian, clusters[b].gaussian);
    clusters[a].log_det = std::log(clusters[a].gaussian.cov.determinant());
    clusters[a].node = static_cast<std::uint32_t>(data.size() + dendrogram.merges.size() - 1);
    clusters[b].live = false;
    clusters[b].least = kInfinity;
    findPartner(a);
    for (std::size_t i = 0; i < b; ++i) {
      if (!clusters[i].live || i == a) continue;
      if (clusters[i].partner == a || clusters[i].partner == b) {
        findPartner(i);
      } else if (i < a) {
        const double value = cost(clusters[i], clusters[a]);
        if (value < clusters[i].least) {
          clusters[i].least = value;
          clusters[i].partner = a;
        }
      }
    }
  }
  return dendrogram;
}

}  // namespace gaussmap::refinement
