// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/map_export.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/ellipsoid_pose.h"
#include "gaussmap/map/queries.h"
#include "io/export/colours.h"
#include "io/files/write_buffer.h"
#include "map/map_origin.h"
#include "mesh/shapes.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr int kFacets = 8;                         // facets of an ellipsoid around its equator
constexpr int kRest = 45;                          // coefficients of a splat's higher spherical harmonics
constexpr double kHarmonic = 0.28209479177387814;  // the constant spherical harmonic, 1 / (2 sqrt(pi))
constexpr double kMinDeviation = 1e-9;             // [m]; the logarithm of 0 would not be finite

/// A Gaussian and its values that all three kinds of file need.
struct Item {
  Gaussian<3> gaussian;  // mean relative to the origin
  EllipsoidPose pose;
  float log_odds;
};

/// Computes the Gaussians to export one by one, so that they need not all be in memory.
class Items {
 public:
  Items(const GaussianMap<3>& map, const GaussianPlyOptions& options)
      : map_(map),
        ids_(options.scale ? gaussiansOfScale(map, *options.scale) : leaves(map)),
        colour_(options.colour),
        origin_(mapOrigin(map)) {
    std::vector<double> heights;
    heights.reserve(ids_.size());
    if (colour_ == PlyColour::Height)
      for (const GaussianId& id : ids_) heights.push_back(gaussianAbout(origin_, map_, id.index, id.scale).mean.z());
    heights_ = colourRange(std::move(heights));
  }
  std::size_t size() const { return ids_.size(); }
  const Vector<3>& origin() const { return origin_; }
  Item at(std::size_t i) const {
    const GaussianId& id = ids_[i];
    const Gaussian<3> gaussian = gaussianAbout(origin_, map_, id.index, id.scale);
    return {gaussian, ellipsoidPose(gaussian), map_.logOdds(id.index, id.scale)};
  }
  Colour colourOf(const Item& item) const {
    if (colour_ == PlyColour::Normal) return normalColour(item.pose.normal());
    return viridis((item.gaussian.mean.z() - heights_.first) / (heights_.second - heights_.first));
  }

 private:
  const GaussianMap<3>& map_;
  std::vector<GaussianId> ids_;
  PlyColour colour_;
  Vector<3> origin_;
  std::pair<double, double> heights_;
};

std::string begin(const Vector<3>& origin) {
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment a Gaussian map\n";
  if (!origin.isZero()) {
    header += "comment origin";
    for (int axis = 0; axis < 3; ++axis) {
      char digits[32];
      header += " " + std::string(digits, std::to_chars(digits, digits + sizeof digits, origin(axis)).ptr);
    }
    header += '\n';
  }
  return header;
}

std::string properties(const char* type, std::initializer_list<const char*> names) {
  std::string lines;
  for (const char* const name : names) lines += std::string("property ") + type + " " + name + "\n";
  return lines;
}

std::string vertexElement(std::size_t count) {
  return "element vertex " + std::to_string(count) + "\n" + properties("float", {"x", "y", "z"});
}

void add(WriteBuffer& buffer, const Vector<3>& values) {
  for (int axis = 0; axis < 3; ++axis) buffer.add(static_cast<float>(values(axis)));
}

void add(WriteBuffer& buffer, const Colour& colour) {
  for (const std::uint8_t channel : colour) buffer.add(channel);
}

void writePoints(WriteBuffer& buffer, const Items& items) {
  buffer.addText(begin(items.origin()) + vertexElement(items.size()) + properties("float", {"nx", "ny", "nz"}) +
                 properties("uchar", {"red", "green", "blue"}) + properties("float", {"weight"}) + "end_header\n");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item item = items.at(i);
    add(buffer, item.gaussian.mean);
    add(buffer, item.pose.normal());
    add(buffer, items.colourOf(item));
    buffer.add(static_cast<float>(item.gaussian.weight));
  }
}

void writeSplats(WriteBuffer& buffer, const Items& items) {
  std::string header = begin(items.origin()) + vertexElement(items.size()) +
                       properties("float", {"nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"});
  for (int i = 0; i < kRest; ++i) header += "property float f_rest_" + std::to_string(i) + "\n";
  header += properties("float", {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"});
  buffer.addText(header + "end_header\n");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item item = items.at(i);
    add(buffer, item.gaussian.mean);
    add(buffer, item.pose.normal());
    for (const std::uint8_t channel : items.colourOf(item))
      buffer.add(static_cast<float>((channel / 255.0 - 0.5) / kHarmonic));
    for (int rest = 0; rest < kRest; ++rest) buffer.add(0.0f);
    buffer.add(item.log_odds);
    add(buffer, item.pose.deviations.cwiseMax(kMinDeviation).array().log().matrix());
    for (const double part :
         {item.pose.rotation.w(), item.pose.rotation.x(), item.pose.rotation.y(), item.pose.rotation.z()})
      buffer.add(static_cast<float>(part));
  }
}

void writeEllipsoids(WriteBuffer& buffer, const Items& items, double sigma) {
  const TriangleMesh sphere = ellipsoidMesh(Vector<3>::Zero(), Vector<3>::Ones(), kFacets);
  const std::size_t corners = sphere.vertices.size();
  if (items.size() > std::size_t{std::numeric_limits<std::int32_t>::max()} / corners)
    throw std::length_error(std::to_string(items.size()) +
                            " ellipsoids are too many for one mesh: use a coarser scale");
  buffer.addText(begin(items.origin()) + vertexElement(items.size() * corners) +
                 properties("uchar", {"red", "green", "blue"}) + "element face " +
                 std::to_string(items.size() * sphere.triangles.size()) +
                 "\nproperty list uchar int vertex_indices\nend_header\n");
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item item = items.at(i);
    const Colour colour = items.colourOf(item);
    const Matrix<3> axes = item.pose.rotation.toRotationMatrix() * (sigma * item.pose.deviations).asDiagonal();
    for (const Eigen::Vector3d& corner : sphere.vertices) {
      add(buffer, item.gaussian.mean + axes * corner);
      add(buffer, colour);
    }
  }
  for (std::size_t i = 0; i < items.size(); ++i)
    for (const TriangleMesh::Triangle& triangle : sphere.triangles) {
      buffer.add(std::uint8_t{3});
      for (const std::uint32_t corner : triangle) buffer.add(static_cast<std::int32_t>(i * corners + corner));
    }
}

}  // namespace

std::size_t savePly(const std::filesystem::path& path, const GaussianMap<3>& map, const GaussianPlyOptions& options) {
  require(options.sigma > 0.0 && std::isfinite(options.sigma), "sigma", options.sigma, "must be positive and finite");
  const Items items(map, options);
  AtomicFile file(path);
  WriteBuffer buffer(file);
  switch (options.content) {
    case PlyContent::Ellipsoids:
      writeEllipsoids(buffer, items, options.sigma);
      break;
    case PlyContent::Points:
      writePoints(buffer, items);
      break;
    case PlyContent::Splats:
      writeSplats(buffer, items);
      break;
  }
  buffer.flush();
  file.commit();
  return items.size();
}

}  // namespace gaussmap
