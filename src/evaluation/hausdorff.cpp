// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/evaluation/hausdorff.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "core/in_space.h"
#include "core/parallel.h"
#include "core/quantile.h"
#include "gaussmap/map/queries.h"
#include "mesh/mesh_distance.h"
#include "points/nearest_search.h"

namespace gaussmap {
using namespace detail;

DistanceSummary summarise(std::vector<double> distances) {
  if (distances.empty()) throw std::invalid_argument("no distances to summarise");
  DistanceSummary summary;
  summary.count = distances.size();
  double sum = 0.0, squares = 0.0;  // before the quantiles reorder the values
  for (const double distance : distances) {
    sum += distance;
    squares += distance * distance;
    summary.max = std::max(summary.max, distance);
  }
  summary.mean = sum / static_cast<double>(summary.count);
  summary.rms = std::sqrt(squares / static_cast<double>(summary.count));
  summary.q99 = percentile(distances, 99);
  summary.q95 = percentile(distances, 95);
  return summary;
}

namespace {

HausdorffResult summariseBoth(const std::vector<double>& forward, const std::vector<double>& backward, int threads) {
  HausdorffResult result;
  parallelFor(2, threads, 1, [&](std::size_t i) {
    (i == 0 ? result.forward : result.backward) = summarise(i == 0 ? forward : backward);
  });
  return result;
}

void checkSet(const std::vector<Vector<3>>& points, const char* name) {
  if (points.empty()) throw std::invalid_argument("the Hausdorff distance of an empty set is not defined");
  checkPoints(points, name);
}

}  // namespace

template <int D>
HausdorffResult hausdorff(const std::vector<Vector<D>>& a, const std::vector<Vector<D>>& b, int threads,
                          PointDistances* distances) {
  const std::vector<Vector<3>>&subject = inSpace(a), &reference = inSpace(b);
  checkSet(subject, "a");
  checkSet(reference, "b");
  const PointTreePair trees(subject, reference, threads);
  std::vector<double> forward = nearestDistances(trees.a(), trees.b(), threads);
  std::vector<double> backward = nearestDistances(trees.b(), trees.a(), threads);
  const HausdorffResult result = summariseBoth(forward, backward, threads);
  if (distances != nullptr) *distances = {subject, std::move(forward), std::move(backward)};
  return result;
}

template <int D>
HausdorffMaxima hausdorffMaxima(const std::vector<Vector<D>>& a, const std::vector<Vector<D>>& b, int threads) {
  const std::vector<Vector<3>>&from = inSpace(a), &to = inSpace(b);
  checkSet(from, "a");
  checkSet(to, "b");
  const PointTreePair trees(from, to, threads);
  return {largestNearestDistance(trees.a(), trees.b(), threads), largestNearestDistance(trees.b(), trees.a(), threads)};
}

/// The points of the reference and their tree, and the mesh if the reference is a mesh.
struct Reference::Parts {
  explicit Parts(std::vector<Vector<3>> given)
      : points(std::move(given)), tree((checkSet(points, "reference"), points)) {}

  std::vector<double> forward(const std::vector<Vector<3>>& from, const PointTree& from_tree, int threads) const {
    return mesh ? meshDistances(from, *mesh, threads) : nearestDistances(from_tree, tree, threads);
  }

  std::vector<Vector<3>> points;
  PointTree tree;
  std::optional<MeshDistance> mesh;
  std::unique_ptr<const Parts> near;  // if the reference is a map: its samples near their means; or null
  bool is_map = false;
};

template <int D>
Reference::Reference(std::vector<Vector<D>> points)
    : parts_(std::make_shared<const Parts>(inSpace(std::move(points)))) {}

Reference::Reference(const TriangleMesh& mesh, std::size_t samples, std::uint64_t seed) {
  if (samples == 0) throw std::invalid_argument("a mesh as reference needs at least one sample");
  const auto parts = std::make_shared<Parts>(sampleSurface(mesh, samples, seed));
  parts->mesh.emplace(mesh);
  parts_ = parts;
}

template <int D>
Reference::Reference(const MapSamples<D>& samples) {
  if (samples.points.empty()) throw std::invalid_argument("no samples of the map to compare with");
  const auto parts = std::make_shared<Parts>(inSpace(samples.points));
  parts->is_map = true;
  std::vector<Vector<3>> near = inSpace(samples.within(2.0));
  if (!near.empty()) parts->near = std::make_unique<const Parts>(std::move(near));
  parts_ = parts;
}

const std::vector<Vector<3>>& Reference::points() const {
  return parts_->points;
}

template <int D>
HausdorffResult Reference::compare(const std::vector<Vector<D>>& points, int threads, PointDistances* distances) const {
  const std::vector<Vector<3>>& subject = inSpace(points);
  checkSet(subject, "subject");
  const PointTree tree(subject);
  std::vector<double> forward = parts_->forward(subject, tree, threads);
  std::vector<double> backward = nearestDistances(parts_->tree, tree, threads);
  const HausdorffResult result = summariseBoth(forward, backward, threads);
  if (distances != nullptr) *distances = {subject, std::move(forward), std::move(backward)};
  return result;
}

template <int D>
MapHausdorff Reference::compareSamples(const MapSamples<D>& samples, int threads, PointDistances* distances) const {
  if (samples.points.empty())
    throw std::invalid_argument("no samples: no Gaussian of the scale has probability mass within its bounds");

  MapHausdorff result;
  result.samples = samples.points.size();
  result.unplaced = samples.unplaced;
  PointDistances all;
  result.all = compare(samples.points, threads, &all);

  const std::vector<Vector<3>> near = inSpace(samples.within(2.0));
  if (!near.empty() && parts_->is_map && parts_->near) {
    const PointTree tree(near);
    result.within_two_sigma = summariseBoth(parts_->near->forward(near, tree, threads),
                                            nearestDistances(parts_->near->tree, tree, threads), threads);
  } else if (!near.empty() && !parts_->is_map) {
    std::vector<double> forward;  // the distances of the near samples are already known
    forward.reserve(near.size());
    for (std::size_t i = 0; i < all.forward.size(); ++i)
      if (samples.mahalanobis[i] <= 2.0) forward.push_back(all.forward[i]);
    result.within_two_sigma = summariseBoth(forward, nearestDistances(parts_->tree, PointTree(near), threads), threads);
  }
  if (distances != nullptr) *distances = std::move(all);
  return result;
}

template <int D>
MapHausdorff Reference::compare(const GaussianMap<D>& map, int scale, const SampleOptions& options,
                                PointDistances* distances) const {
  MapHausdorff result = compareSamples(sampleMap(map, scale, options), options.threads, distances);
  result.gaussians = map.gaussianCount(scale);
  return result;
}

template <int D>
MapHausdorff Reference::compareLeaves(const GaussianMap<D>& map, const SampleOptions& options,
                                      PointDistances* distances) const {
  MapHausdorff result = compareSamples(sampleLeaves(map, options), options.threads, distances);
  result.gaussians = leaves<D>(map).size();
  return result;
}

template <int D>
MapHausdorff evaluateMap(const GaussianMap<D>& map, int scale, const std::vector<Vector<D>>& reference,
                         const SampleOptions& options) {
  return Reference(reference).compare(map, scale, options);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                       \
  template HausdorffResult hausdorff<D>(const std::vector<Vector<(D)>>&, const std::vector<Vector<(D)>>&, int,        \
                                        PointDistances*);                                                             \
  template HausdorffMaxima hausdorffMaxima<D>(const std::vector<Vector<(D)>>&, const std::vector<Vector<(D)>>&, int); \
  template Reference::Reference(std::vector<Vector<(D)>>);                                                            \
  template Reference::Reference(const MapSamples<D>&);                                                                \
  template HausdorffResult Reference::compare<D>(const std::vector<Vector<(D)>>&, int, PointDistances*) const;        \
  template MapHausdorff Reference::compare<D>(const GaussianMap<D>&, int, const SampleOptions&, PointDistances*)      \
      const;                                                                                                          \
  template MapHausdorff Reference::compareLeaves<D>(const GaussianMap<D>&, const SampleOptions&, PointDistances*)     \
      const;                                                                                                          \
  template MapHausdorff evaluateMap<D>(const GaussianMap<D>&, int, const std::vector<Vector<(D)>>&,                   \
                                       const SampleOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
