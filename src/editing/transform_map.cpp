// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/transform_map.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "editing/regroup.h"
#include "gaussmap/mapping/refine.h"
#include "map/areas.h"
#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "map/map_scale_builder.h"
#include "mapping/scale_clusters.h"

namespace gaussmap {
using namespace detail;

namespace {

template <int D>
void check(const RigidMotion<D>& motion) {
  const Matrix<D>& rotation = motion.rotation;
  if (!motion.translation.allFinite() || !rotation.allFinite()) throw std::invalid_argument("the motion is not finite");
  const double off = (rotation * rotation.transpose() - Matrix<D>::Identity()).cwiseAbs().maxCoeff();
  if (off > 1e-9 || Eigen::Matrix<double, D, D>(rotation).determinant() < 0.0)
    throw std::invalid_argument("the motion's rotation is none: its matrix is not orthogonal with determinant 1");
  if (!motion.covariance) return;
  const Eigen::MatrixXd cov = *motion.covariance;
  const std::string what = "the covariance of the motion ";
  if (!cov.allFinite()) throw std::invalid_argument(what + "is not finite");
  const double scale = cov.cwiseAbs().maxCoeff();
  if ((cov - cov.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale)
    throw std::invalid_argument(what + "is not symmetric");
  if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(cov).eigenvalues().minCoeff() < -1e-9 * scale)
    throw std::invalid_argument(what + "is not positive semi-definite");
}

/// d (moved point) / d (translation, rotation); `arm` = the moved point about the moved origin.
Eigen::Matrix<double, 3, 6> jacobian(const Vector<3>& arm) {
  Eigen::Matrix<double, 3, 6> result;
  result << 1, 0, 0, 0, arm.z(), -arm.y(),  //
      0, 1, 0, -arm.z(), 0, arm.x(),        //
      0, 0, 1, arm.y(), -arm.x(), 0;
  return result;
}
Eigen::Matrix<double, 2, 3> jacobian(const Vector<2>& arm) {
  Eigen::Matrix<double, 2, 3> result;
  result << 1, 0, -arm.y(),  //
      0, 1, arm.x();
  return result;
}

/// Of a Gaussian in the map frame.
template <int D>
Gaussian<D> moved(const Gaussian<D>& gaussian, const RigidMotion<D>& motion) {
  const Vector<D> arm = motion.rotation * gaussian.mean;
  Gaussian<D> result{arm + motion.translation, motion.rotation * gaussian.cov * motion.rotation.transpose(),
                     gaussian.weight};
  if (motion.covariance) {
    const auto j = jacobian(arm);
    result.cov += j * *motion.covariance * j.transpose();
  }
  result.cov = 0.5 * (result.cov + Matrix<D>(result.cov.transpose()));  // to the last bit
  return result;
}

/// A Gaussian of the finest scale on its way.
template <int D>
struct Traveller {
  Gaussian<D> gaussian;  // map frame of the target
  CellKey<D> key;        // its cell there
  float log_odds = kMaxOccupancy;
  std::uint32_t group = 0;  // its old cluster of scale 1; not used in another grid
};

/// Halves a Gaussian along its long axis while that is longer than a cell and the halves lie in different cells.
/// The parts have together its weight, mean and covariance: that of two halves of a uniform rod.
template <int D>
void split(const Traveller<D>& whole, const Grid<D>& grid, std::vector<Traveller<D>>& parts) {
  const PrincipalAxes<D> axes = principalAxes(whole.gaussian);
  const double variance = axes.variances(D - 1), side = grid.side(0);
  if (12.0 * variance > side * side) {
    const Vector<D> step = std::sqrt(0.75 * variance) * axes.directions.col(D - 1);
    Traveller<D> low = whole;
    low.gaussian.weight *= 0.5;
    low.gaussian.cov -= step * step.transpose();
    Traveller<D> high = low;
    low.gaussian.mean -= step;
    high.gaussian.mean += step;
    low.key = grid.keyOf(low.gaussian.mean);
    high.key = grid.keyOf(high.gaussian.mean);
    if (low.key != high.key) {
      split(low, grid, parts);
      split(high, grid, parts);
      return;
    }
  }
  parts.push_back(whole);
}

template <int D>
class Mover {
 public:
  Mover(const GaussianMap<D>& map, const RigidMotion<D>& motion, const TransformOptions& options)
      : map_(map),
        motion_(motion),
        options_(options),
        grid_(options.grid.value_or(map.options())),
        same_cells_(grid_.side(0) == map.grid().side(0)) {}

  GaussianMap<D> run() const {
    std::vector<std::uint32_t> group;  // the old cluster of each Gaussian of the scale that was made last
    std::vector<MapScale<D>> scales;
    scales.push_back(finestScale(group));
    const MapOptions &ours = grid_.options(), &theirs = map_.options();
    const bool same_grid = same_cells_ && ours.ratio == theirs.ratio && ours.scales == theirs.scales;
    if (!same_grid) return inAnotherGrid(std::move(scales.front()));
    std::vector<double> areas = finestAreas(scales.front());
    for (int s = 1; s < grid_.scales(); ++s) scales.push_back(coarseScale(scales.back(), s, group, areas));
    return GaussianMap<D>(ours, std::move(scales));
  }

 private:
  std::vector<Traveller<D>> travellers() const {
    std::vector<Traveller<D>> all(map_.gaussianCount(0));
    parallelFor(map_.cellCount(0), options_.threads, 1024, [&](std::size_t cell) {
      const Vector<D> centre = map_.grid().centre(map_.scale(0).keys[cell], 0);
      const IndexRange range = map_.gaussiansOf(cell, 0);
      for (std::size_t i = range.first; i < range.last; ++i) {
        Gaussian<D> gaussian = map_.localGaussian(i, 0);
        gaussian.mean += centre;
        gaussian = moved(gaussian, motion_);
        all[i] = {gaussian, grid_.keyOf(gaussian.mean), map_.logOdds(i, 0),
                  map_.scales() > 1 ? map_.scale(0).parent[i] : 0};
      }
    });
    if (grid_.side(0) >= map_.grid().side(0)) return all;
    std::vector<Traveller<D>> parts;
    for (const Traveller<D>& one : all) split(one, grid_, parts);
    return parts;
  }

  MapScale<D> finestScale(std::vector<std::uint32_t>& group) const {
    const std::vector<Traveller<D>> all = travellers();
    std::vector<CellKey<D>> keys;
    keys.reserve(all.size());
    for (const Traveller<D>& one : all) keys.push_back(one.key);
    std::vector<std::uint32_t> order = keyOrder<D>(keys, grid_.options().ratio, grid_.scales() - 1);
    MapScaleBuilder<D> finest;
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
      const CellKey<D>& key = keys[order[first]];
      for (last = first + 1; last < order.size() && keys[order[last]] == key;) ++last;
      // Long codes are sorted without regard to the order of equals.
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(last));
      const Vector<D> centre = grid_.centre(key, 0);
      finest.addCell(key);
      std::vector<Gaussian<D>> here;
      float highest = -kMaxOccupancy;
      for (std::size_t i = first; i < last; ++i) {
        const Traveller<D>& one = all[order[i]];
        highest = std::max(highest, one.log_odds);
        here.push_back(one.gaussian);
        here.back().mean -= centre;
        if (!same_cells_) continue;
        group.push_back(one.group);
        if (map_.hasOccupancy()) finest.addLogOdds(one.log_odds);
      }
      if (!same_cells_) {
        here = {merge(here)};
        if (map_.hasOccupancy()) finest.addLogOdds(highest);
      }
      for (const Gaussian<D>& gaussian : here) finest.addGaussian(gaussian);
    }
    return finest.take();
  }

  /// `group` = the old cluster of scale 1 that each finest Gaussian comes from. Above, there are few Gaussians below a
  /// scale, and each starts as a cluster: old ones, cut to pieces, would leave samples of the coarsest scale 5 %
  /// farther from the points. `areas` = those of the finer Gaussians; then of those that are made.
  MapScale<D> coarseScale(MapScale<D>& finer, int s, std::vector<std::uint32_t>& group,
                          std::vector<double>& areas) const {
    if (s > 1) std::iota(group.begin(), group.end(), 0u);
    const bool is_refined = map_.gaussianCount(s) > map_.cellCount(s);
    const Regrouping<D> from{finer, grid_, s, group, areas, options_.threads};
    Regrouped<D> made = regroup<D>(from, [&](const MapScale<D>& scale, const std::vector<double>& own_areas) {
      const std::size_t cells = scale.keys.size();
      if (!is_refined || map_.gaussianCount(s) <= cells) return onePerCell<D>(scale);
      return ScaleClusters::within(scale, grid_, s, own_areas, options_.merge_cost, options_.threads)
          .cut(map_.gaussianCount(s) - cells);
    });
    group = std::move(made.group);
    areas = std::move(made.areas);
    return std::move(made.scale);
  }

  GaussianMap<D> inAnotherGrid(MapScale<D> finest) const {
    std::vector<MapScale<D>> scales;
    scales.push_back(std::move(finest));
    RefineOptions refinement;
    refinement.merge_cost = options_.merge_cost;
    refinement.threads = options_.threads;
    MaxGaussians budget;
    bool is_refined = false;
    for (int s = 1; s < grid_.scales(); ++s) {
      MapScale<D> coarse = coarsen(scales.back(), grid_, s - 1);
      inheritOccupancy<D>(scales.back(), coarse);
      scales.push_back(std::move(coarse));
      const int as = std::min(s, map_.scales() - 1);
      const auto cells = static_cast<double>(scales.back().keys.size());
      const double per_cell = static_cast<double>(map_.gaussianCount(as)) / static_cast<double>(map_.cellCount(as));
      budget.by_scale[s] = static_cast<std::size_t>(cells * per_cell);
      is_refined |= budget.by_scale[s] > scales.back().keys.size();
    }
    GaussianMap<D> map(grid_.options(), std::move(scales));
    return is_refined ? refine<D>(std::move(map), budget, refinement).map : map;
  }

  const GaussianMap<D>& map_;
  const RigidMotion<D>& motion_;
  const TransformOptions& options_;
  const Grid<D> grid_;
  const bool same_cells_;
};

}  // namespace

template <int D>
RigidMotion<D> RigidMotion<D>::inverse() const {
  RigidMotion result{rotation.transpose(), -(rotation.transpose() * translation), std::nullopt};
  if (!covariance) return result;
  // An error (dt, dr) of t and R, seen from the other frame: rotated, and moved to the other origin.
  PoseCovariance<D> j = PoseCovariance<D>::Zero();
  j.template topRows<D>() = result.rotation * jacobian(Vector<D>(-translation));
  if constexpr (D == 3)
    j.template bottomRightCorner<3, 3>() = result.rotation;
  else
    j(2, 2) = 1.0;
  result.covariance = j * *covariance * j.transpose();
  return result;
}

RigidMotion<3> rigidMotion(const Pose& pose) {
  return {pose.rotation.toRotationMatrix(), pose.translation, std::nullopt};
}

template <int D>
GaussianMap<D> transformMap(const GaussianMap<D>& map, const RigidMotion<D>& motion, const TransformOptions& options) {
  check(motion);
  const MapOptions grid = Grid<D>(options.grid.value_or(map.options())).options();
  const bool stays = motion.rotation == Matrix<D>::Identity() && motion.translation == Vector<D>::Zero();
  if (stays && !motion.covariance && grid == map.options()) return map;
  if (map.isCompressed())
    throw std::invalid_argument(
        "a compressed map has no detail that could be sorted into other cells: move the map that it was made from, "
        "then compress");
  if (map.empty()) return GaussianMap<D>(grid);
  return Mover<D>(map, motion, options).run();
}

#define GAUSSMAP_INSTANTIATE(D)   \
  template struct RigidMotion<D>; \
  template GaussianMap<D> transformMap<D>(const GaussianMap<D>&, const RigidMotion<D>&, const TransformOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
