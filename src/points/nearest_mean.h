// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Finds the Gaussian whose mean is nearest to a point. There must be at least one Gaussian, and the Gaussians must
/// outlive this object.
class NearestMean {
 public:
  explicit NearestMean(const std::vector<Gaussian<3>>& gaussians) : set_{gaussians}, tree_(3, set_) {}

  std::uint32_t find(const Vector<3>& point) const {
    std::uint32_t nearest = 0;
    double square = 0.0;
    tree_.knnSearch(point.data(), 1, &nearest, &square);
    return nearest;
  }

 private:
  struct Set {
    const std::vector<Gaussian<3>>& gaussians;
    std::size_t kdtree_get_point_count() const { return gaussians.size(); }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const { return gaussians[i].mean[Eigen::Index(axis)]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Set>, Set, 3, std::uint32_t>;

  Set set_;
  Tree tree_;
};

}  // namespace gaussmap::detail
