// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "core/number_text.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "map/child_links.h"
#include "map/in_space.h"
#include "map/map_origin.h"
#include "map/map_scale_builder.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kRounding = 1e-6;  // possible error of an eigenvalue after rounding to float, relative to the largest

GaussianRecord toRecord(const GaussianMap<3>& map, std::size_t index, int scale, const Eigen::Vector3d& origin) {
  const CellKey<3>& key = map.scale(scale).keys[map.cellOf(index, scale)];
  const Gaussian<3> gaussian = gaussianAbout(origin, map, index, scale);
  const Eigen::Vector3d& mean = gaussian.mean;
  const Eigen::Matrix3f cov = gaussian.cov.cast<float>();
  return {{mean.x(), mean.y(), mean.z()},
          {cov(0, 0), cov(0, 1), cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2)},
          static_cast<float>(gaussian.weight),
          map.logOdds(index, scale),
          static_cast<float>(map.grid().side(scale)),
          static_cast<float>(scale),
          key};
}

Matrix<3> positiveDefinite(const GaussianRecord& record) {
  const auto& c = record.covariance;
  Eigen::Matrix3d cov;
  cov << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  if (!cov.allFinite()) throw std::invalid_argument("a covariance is not finite");
  if (Eigen::LLT<Eigen::Matrix3d>(cov).info() == Eigen::Success) return cov;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cov);
  const double largest = solver.eigenvalues().maxCoeff();
  if (!(largest > 0.0) || solver.eigenvalues().minCoeff() < -kRounding * largest)
    throw std::invalid_argument("a covariance is not positive definite");
  const Eigen::Vector3d lifted = solver.eigenvalues().cwiseMax(kRounding * largest);
  return solver.eigenvectors() * lifted.asDiagonal() * solver.eigenvectors().transpose();
}

/// Returns the shortest decimal that rounds to this float: 0.1, not 0.100000001490116.
double asWritten(float value) {
  char text[32];
  const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
  double decimal = static_cast<double>(value);
  std::from_chars(text, end, decimal);
  return decimal;
}

MapOptions optionsOf(const std::map<int, float>& sides) {
  MapOptions options;
  const int finest = sides.begin()->first;
  options.resolution = asWritten(sides.begin()->second);
  options.scales = static_cast<int>(sides.size());
  // The file does not store the noise floor. This is the default, or more if the coarsest cells need it (see Grid).
  options.noise = std::max(options.resolution / 20.0, 1.01e-7 * static_cast<double>(sides.rbegin()->second));
  if (sides.size() > 1) {
    const double ratio =
        static_cast<double>(std::next(sides.begin())->second) / static_cast<double>(sides.begin()->second);
    options.ratio = static_cast<int>(std::lround(std::clamp(ratio, 0.0, 1e6)));
  }
  const Grid<3> grid(options);
  int expected = finest;
  for (const auto& [scale, side] : sides) {
    if (scale != expected++ || std::abs(static_cast<double>(side) / grid.side(scale - finest) - 1.0) > 1e-5)
      throw std::invalid_argument("its scales and cell sides do not form a grid with one ratio");
  }
  return options;
}

struct CellGroup {
  std::vector<Gaussian<3>> gaussians;  // means relative to the centre of the cell
  std::vector<float> log_odds;
};
using CellGroups = std::map<CellKey<3>, CellGroup>;

/// Returns the index of the parent: of the clusters `among` in the parent cell, the one with the smallest KL divergence
/// from the child. The means of the clusters are relative to the centre of the parent cell. The mean of the child is
/// relative to the centre of its own cell, which is at `centre_in_parent`.
std::size_t nearestParent(Gaussian<3> child, const Vector<3>& centre_in_parent,
                          const std::vector<Gaussian<3>>& clusters, IndexRange among) {
  child.mean += centre_in_parent;
  std::size_t best = among.first;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = among.first; i < among.last; ++i) {
    const double divergence = klDivergence<3>(child, clusters[i]);
    if (divergence < least) {
      least = divergence;
      best = i;
    }
  }
  return best;
}

}  // namespace

GaussianRecords toRecords(const GaussianMap<3>& map, std::optional<int> scale) {
  if (scale && (*scale < 0 || *scale >= map.scales()))
    throw std::out_of_range("scale " + std::to_string(*scale) + ": the map has the scales 0 to " +
                            std::to_string(map.scales() - 1));
  GaussianRecords all{{}, mapOrigin(map)};
  for (int s = map.scales() - 1; s >= 0; --s)
    if (!scale || *scale == s)
      for (std::size_t i = 0; i < map.gaussianCount(s); ++i) all.records.push_back(toRecord(map, i, s, all.origin));
  return all;
}

GaussianRecords toRecords(const GaussianMap<2>& map, std::optional<int> scale) {
  return toRecords(inSpace(map), scale);
}

GaussianMap<3> fromRecords(const GaussianRecords& all) {
  if (all.records.empty()) throw std::invalid_argument("it has no Gaussians");
  std::map<int, float> sides;
  for (const GaussianRecord& record : all.records) {
    if (!(record.weight > 0.0f) || !std::isfinite(record.weight))
      throw std::invalid_argument("a Gaussian has the weight " + numberText(record.weight) +
                                  ", expected a positive number");
    if (!(record.scale >= 0.0f && record.scale < 64.0f) || record.scale != std::floor(record.scale))
      throw std::invalid_argument("a Gaussian has the scale " + numberText(record.scale) +
                                  ", expected a whole number from 0 to 63");
    const int scale = static_cast<int>(record.scale);
    if (sides.emplace(scale, record.cell_side).first->second != record.cell_side)
      throw std::invalid_argument("the cells of scale " + std::to_string(scale) + " have different sides");
  }
  const MapOptions options = optionsOf(sides);
  const Grid<3> grid(options);
  const int finest = sides.begin()->first;

  std::vector<CellGroups> cells(sides.size());
  for (const GaussianRecord& record : all.records) {
    const int scale = static_cast<int>(record.scale) - finest;
    const double half = 0.5 * grid.side(scale);
    Gaussian<3> gaussian;
    const Eigen::Vector3d mean(record.mean[0], record.mean[1], record.mean[2]);
    gaussian.mean = mean + (all.origin - grid.centre(record.cell, scale));
    if (!gaussian.mean.allFinite() || gaussian.mean.cwiseAbs().maxCoeff() > 1.1 * half)
      throw std::invalid_argument("a mean lies outside its cell " + toString<3>(record.cell));
    gaussian.mean = gaussian.mean.cwiseMax(-half).cwiseMin(half);
    gaussian.cov = positiveDefinite(record);
    gaussian.weight = static_cast<double>(record.weight);
    CellGroup& group = cells[static_cast<std::size_t>(scale)][record.cell];
    group.gaussians.push_back(gaussian);
    group.log_odds.push_back(record.occupancy);
  }

  const bool occupancy = std::any_of(all.records.begin(), all.records.end(),
                                     [](const GaussianRecord& record) { return record.occupancy != kMaxOccupancy; });
  std::vector<MapScale<3>> scales(sides.size());
  for (int s = 0; s < options.scales; ++s) {
    MapScale<3>& scale = scales[static_cast<std::size_t>(s)];
    const CellGroups& groups = cells[static_cast<std::size_t>(s)];
    std::vector<CellKey<3>> keys;
    for (const auto& [key, group] : groups) keys.push_back(key);
    MapScaleBuilder<3> builder;
    for (const std::uint32_t from : keyOrder<3>(keys, options.ratio, options.scales - 1 - s)) {
      const CellGroup& group = groups.at(keys[from]);
      builder.addCell(keys[from]);
      for (const Gaussian<3>& gaussian : group.gaussians) builder.addGaussian(gaussian);
      for (const float log_odds : group.log_odds)
        if (occupancy) builder.addLogOdds(log_odds);
    }
    scale = builder.take();
    if (s == 0) continue;
    MapScale<3>& finer = scales[static_cast<std::size_t>(s) - 1];
    scale.first_child = childLinks<3>(finer.keys, scale.keys, grid, s);
    for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
      const IndexRange clusters = gaussiansOf(scale, cell);
      for (std::size_t child = scale.first_child[cell]; child < scale.first_child[cell + 1]; ++child) {
        const IndexRange range = gaussiansOf(finer, child);
        const Vector<3> centre = grid.centreInParent(finer.keys[child], s - 1);
        for (std::size_t i = range.first; i < range.last; ++i)
          finer.parent.push_back(
              static_cast<std::uint32_t>(nearestParent(finer.gaussians[i], centre, scale.gaussians, clusters)));
      }
    }
  }
  return GaussianMap<3>(options, std::move(scales));
}

}  // namespace gaussmap
