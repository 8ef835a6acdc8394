// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/transform_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/pose_jacobian.h"
#include "editing/recluster.h"
#include "gaussmap/mapping/refine.h"
#include "map/coarsen.h"
#include "map/inherit_occupancy.h"
#include "map/map_scale_builder.h"
#include "map/occupied_areas.h"
#include "mapping/scale_clusters.h"

namespace gaussmap {
using namespace detail;

namespace {

void check(const PoseCovariance& covariance) {
  const std::string what = "the covariance of the motion ";
  if (!covariance.allFinite()) throw std::invalid_argument(what + "is not finite");
  const double scale = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale)
    throw std::invalid_argument(what + "is not symmetric");
  if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance).eigenvalues().minCoeff() < -1e-9 * scale)
    throw std::invalid_argument(what + "is not positive semi-definite");
}

/// A pose in D dimensions, with the covariance of TransformOptions.
template <int D>
struct Motion {
  Matrix<D> rotation;
  Vector<D> translation;
  std::optional<PoseCovariance> covariance;

  Motion(const Pose& given, const std::optional<PoseCovariance>& known) : covariance(known) {
    if (const std::string fault = poseFault(given); !fault.empty())
      throw std::invalid_argument("the motion of the map: " + fault);
    const Pose pose = normalised(given);
    if constexpr (D == 2) requirePlanar(pose);
    rotation = pose.rotation.toRotationMatrix().topLeftCorner<D, D>();
    translation = pose.translation.head<D>();
    if (covariance) check(*covariance);
  }

  bool isIdentity() const {
    return rotation == Matrix<D>::Identity() && translation == Vector<D>::Zero() && !covariance;
  }

  /// Returns the moved Gaussian. The Gaussian is in the map frame.
  Gaussian<D> operator*(const Gaussian<D>& gaussian) const {
    const Vector<D> arm = rotation * gaussian.mean;
    Gaussian<D> result{arm + translation, rotation * gaussian.cov * rotation.transpose(), gaussian.weight};
    if (covariance) {
      Eigen::Vector3d arm3 = Eigen::Vector3d::Zero();
      arm3.head<D>() = arm;
      // In 2-D, the columns of z and of the rotations about x and y are zero.
      const Eigen::Matrix<double, D, 6> j = poseJacobian(arm3).topRows<D>();
      result.cov += j * *covariance * j.transpose();
    }
    result.cov = 0.5 * (result.cov + Matrix<D>(result.cov.transpose()));  // exactly symmetric
    return result;
  }

 private:
  static void requirePlanar(const Pose& pose) {
    if (pose.translation.z() == 0.0 && pose.rotation.x() == 0.0 && pose.rotation.y() == 0.0) return;
    std::ostringstream text;
    text << "the motion of a 2-D map is not planar: the translation has z = " << pose.translation.z()
         << " and the quaternion x = " << pose.rotation.x() << ", y = " << pose.rotation.y() << ", all must be 0";
    throw std::invalid_argument(text.str());
  }
};

/// A Gaussian of the finest scale after the motion.
template <int D>
struct MovedGaussian {
  Gaussian<D> gaussian;  // in the new map frame
  CellKey<D> key;        // its cell in the new grid
  float log_odds = kMaxOccupancy;
  std::uint32_t group = 0;  // its old cluster of scale 1; not used if the grid changes
};

/// Halves a Gaussian along its longest axis, again and again, while this axis is longer than a cell and the halves lie
/// in different cells. Each step splits it like a uniform rod. The parts together have its weight, mean and covariance.
template <int D>
void split(const MovedGaussian<D>& whole, const Grid<D>& grid, std::vector<MovedGaussian<D>>& parts) {
  const PrincipalAxes<D> axes = principalAxes(whole.gaussian);
  const double variance = axes.variances(D - 1), side = grid.side(0);
  if (12.0 * variance > side * side) {
    const Vector<D> step = std::sqrt(0.75 * variance) * axes.directions.col(D - 1);
    MovedGaussian<D> low = whole;
    low.gaussian.weight *= 0.5;
    low.gaussian.cov -= step * step.transpose();
    MovedGaussian<D> high = low;
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
class MapTransformer {
 public:
  MapTransformer(const GaussianMap<D>& map, const Motion<D>& motion, const TransformOptions& options)
      : map_(map),
        motion_(motion),
        options_(options),
        grid_(options.grid.value_or(map.options())),
        same_cells_(grid_.side(0) == map.grid().side(0)) {}

  GaussianMap<D> run() const {
    std::vector<std::uint32_t> group;  // per Gaussian of the latest scale: its old cluster at the next coarser scale
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
  std::vector<MovedGaussian<D>> movedGaussians() const {
    std::vector<MovedGaussian<D>> all(map_.gaussianCount(0));
    parallelFor(map_.cellCount(0), options_.threads, 1024, [&](std::size_t cell) {
      const Vector<D> centre = map_.grid().centre(map_.scale(0).keys[cell], 0);
      const IndexRange range = map_.gaussiansOf(cell, 0);
      for (std::size_t i = range.first; i < range.last; ++i) {
        Gaussian<D> gaussian = map_.localGaussian(i, 0);
        gaussian.mean += centre;
        gaussian = motion_ * gaussian;
        all[i] = {gaussian, grid_.keyOf(gaussian.mean), map_.logOdds(i, 0),
                  map_.scales() > 1 ? map_.scale(0).parent[i] : 0};
      }
    });
    if (grid_.side(0) >= map_.grid().side(0)) return all;
    std::vector<MovedGaussian<D>> parts;
    for (const MovedGaussian<D>& one : all) split(one, grid_, parts);
    return parts;
  }

  MapScale<D> finestScale(std::vector<std::uint32_t>& group) const {
    const std::vector<MovedGaussian<D>> all = movedGaussians();
    std::vector<CellKey<D>> keys;
    keys.reserve(all.size());
    for (const MovedGaussian<D>& one : all) keys.push_back(one.key);
    std::vector<std::uint32_t> order = keyOrder<D>(keys, grid_.options().ratio, grid_.scales() - 1);
    MapScaleBuilder<D> finest;
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
      const CellKey<D>& key = keys[order[first]];
      for (last = first + 1; last < order.size() && keys[order[last]] == key;) ++last;
      // keyOrder() does not keep the order of equal keys if their codes are long.
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.begin() + static_cast<std::ptrdiff_t>(last));
      const Vector<D> centre = grid_.centre(key, 0);
      finest.addCell(key);
      std::vector<Gaussian<D>> here;
      float highest = -kMaxOccupancy;
      for (std::size_t i = first; i < last; ++i) {
        const MovedGaussian<D>& one = all[order[i]];
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

  /// Makes coarse scale s. For scale 1, `group` = per finest Gaussian: its old cluster of scale 1. For coarser scales,
  /// every finer Gaussian starts as a cluster, because there are few of them. Starting from the old clusters, which the
  /// new cells cut to pieces, would put samples of the coarsest scale 5 % farther from the points. `areas` = areas of
  /// the finer Gaussians; on return, of the Gaussians of scale s.
  MapScale<D> coarseScale(MapScale<D>& finer, int s, std::vector<std::uint32_t>& group,
                          std::vector<double>& areas) const {
    if (s > 1) std::iota(group.begin(), group.end(), 0u);
    const bool is_refined = map_.gaussianCount(s) > map_.cellCount(s);
    const ReclusterInput<D> from{finer, grid_, s, group, areas, options_.threads};
    ReclusterResult<D> made = recluster<D>(from, [&](const MapScale<D>& scale, const std::vector<double>& own_areas) {
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
  const Motion<D>& motion_;
  const TransformOptions& options_;
  const Grid<D> grid_;
  const bool same_cells_;
};

}  // namespace

template <int D>
GaussianMap<D> transformMap(const GaussianMap<D>& map, const Pose& pose, const TransformOptions& options) {
  const Motion<D> motion(pose, options.covariance);
  const MapOptions grid = Grid<D>(options.grid.value_or(map.options())).options();
  if (motion.isIdentity() && grid == map.options()) return map;
  if (map.isCompressed())
    throw std::invalid_argument(
        "a compressed map has no finest Gaussians in some cells, so it cannot be transformed: transform the map that "
        "it was made from, then compress");
  if (map.empty()) return GaussianMap<D>(grid);
  return MapTransformer<D>(map, motion, options).run();
}

template GaussianMap<2> transformMap<2>(const GaussianMap<2>&, const Pose&, const TransformOptions&);
template GaussianMap<3> transformMap<3>(const GaussianMap<3>&, const Pose&, const TransformOptions&);

}  // namespace gaussmap
