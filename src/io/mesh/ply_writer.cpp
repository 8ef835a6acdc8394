// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "gaussmap/io/mesh/ply.h"
#include "io/files/atomic_file.h"
#include "io/files/write_buffer.h"

namespace gaussmap {
using namespace detail;

namespace {

void checkFloats(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (mesh.vertices[i].cwiseAbs().maxCoeff() > double{std::numeric_limits<float>::max()})
      throw std::invalid_argument("vertex " + std::to_string(i) + " does not fit into floats: write doubles");
}

}  // namespace

void writePly(const std::filesystem::path& path, const TriangleMesh& mesh, PlyPrecision precision) {
  checkMesh(mesh);
  const bool is_double = precision == PlyPrecision::Double;
  if (!is_double) checkFloats(mesh);
  const std::string type = is_double ? "double" : "float";
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size());
  for (const char* const axis : {"x", "y", "z"}) header += "\nproperty " + type + " " + axis;
  const bool is_wide = mesh.vertices.size() > std::size_t{std::numeric_limits<std::int32_t>::max()};
  header += "\nelement face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar " +
            (is_wide ? "uint" : "int") + " vertex_indices\nend_header\n";

  AtomicFile file(path);
  file.write(header.data(), header.size());
  WriteBuffer buffer(file);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      if (is_double) {
        buffer.add(vertex(axis));
      } else {
        buffer.add(static_cast<float>(vertex(axis)));
      }
    }
  }
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    buffer.add(std::uint8_t{3});
    for (const std::uint32_t index : triangle) buffer.add(index);
  }
  buffer.flush();
  file.commit();
}

}  // namespace gaussmap
