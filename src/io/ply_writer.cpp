// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "gaussmap/io/atomic_file.h"
#include "gaussmap/io/ply.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are written as they are in memory");

namespace gaussmap {
namespace {

constexpr std::size_t kBytesAtOnce = std::size_t{1} << 20;

/// Collects values and hands them over in large pieces.
class Buffer {
 public:
  explicit Buffer(AtomicFile& file) : file_(file) {}
  template <typename T>
  void add(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
    if (bytes_.size() >= kBytesAtOnce) flush();
  }
  void flush() {
    file_.write(bytes_.data(), bytes_.size());
    bytes_.clear();
  }

 private:
  AtomicFile& file_;
  std::string bytes_;
};

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
  Buffer buffer(file);
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
