// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace gaussmap {

World::World(TriangleMesh mesh, std::vector<MovingObject> moving)
    : mesh_(std::move(mesh)), moving_(std::move(moving)), tree_(mesh_) {
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    if (!moving_[i].velocity.allFinite())
      throw std::invalid_argument("the velocity of moving object " + std::to_string(i) + " is not finite");
    moving_trees_.emplace_back(moving_[i].mesh);
  }
}

std::optional<World::Hit> World::intersect(const Ray& ray, double time, double max_range) const {
  std::optional<Hit> first;
  if (const auto hit = tree_.intersect(ray.origin, ray.direction, max_range))
    first = Hit{hit->range, hit->cosine, SurfaceLabel::Static};
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    // Moves the ray against the velocity instead of the object, which stays at its place of time 0.
    const Eigen::Vector3d origin = ray.origin - time * moving_[i].velocity;
    const double limit = first ? first->range : max_range;
    const auto hit = moving_trees_[i].intersect(origin, ray.direction, limit);
    if (hit && (!first || hit->range < first->range)) first = Hit{hit->range, hit->cosine, SurfaceLabel::Moving};
  }
  return first;
}

}  // namespace gaussmap
