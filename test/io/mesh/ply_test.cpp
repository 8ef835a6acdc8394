// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/mesh/ply.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "gaussmap/core/gaussian.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
namespace {

using test::bytesOf;
using test::TemporaryDirectory;

TriangleMesh randomMesh(std::size_t vertices, std::size_t triangles) {
  Random random(vertices);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < vertices; ++i)
    mesh.vertices.emplace_back(random.normal(), 1e6 * random.normal(), random.uniform());
  const auto index = [&] { return static_cast<std::uint32_t>(random.below(vertices)); };
  for (std::size_t i = 0; i < triangles; ++i) mesh.triangles.push_back({index(), index(), index()});
  return mesh;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

template <typename T>
std::string bigEndian(T value) {
  std::string bytes = bytesOf(value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

TEST(Ply, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  for (const TriangleMesh& mesh : {TriangleMesh(), randomMesh(5, 0), randomMesh(3, 1), randomMesh(50000, 90000)}) {
    const std::filesystem::path path = directory.path() / "mesh.ply";
    writePly(path, mesh);
    const TriangleMesh back = readPly(path);
    EXPECT_EQ(back.vertices, mesh.vertices);
    EXPECT_EQ(back.triangles, mesh.triangles);
  }
}

TEST(Ply, InFloatsIsAsExactAsFloatsAre) {
  const TemporaryDirectory directory;
  const TriangleMesh mesh = randomMesh(1000, 500);
  const std::filesystem::path path = directory.path() / "mesh.ply";
  writePly(path, mesh, PlyPrecision::Float);
  const TriangleMesh back = readPly(path);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_EQ(back.vertices[i](axis), double{static_cast<float>(mesh.vertices[i](axis))});
  EXPECT_EQ(back.triangles, mesh.triangles);
}

TEST(Ply, IsWrittenAsTheFormatHasIt) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "mesh.ply";
  writePly(path, {{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, {{2, 0, 1}}}, PlyPrecision::Float);
  std::string expected =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 1; i <= 9; ++i) expected += bytesOf(static_cast<float>(i));
  expected += bytesOf(std::uint8_t{3}) + bytesOf(2) + bytesOf(0) + bytesOf(1);
  EXPECT_EQ(contents(path), expected);
}

TEST(Ply, IsReadFromAllThreeEncodings) {
  const TemporaryDirectory directory;
  const std::string body =
      " 1.0\ncomment made by hand\nobj_info none\nelement vertex 3\nproperty double z\nproperty uchar red\nproperty "
      "float x\n"
      "property short y\nelement face 1\nproperty uchar flag\nproperty list ushort uint vertex_index\nend_header\n";
  const auto binary = [](auto bytes) {
    std::string data;
    for (int i = 0; i < 3; ++i)
      data += bytes(0.25 + i) + bytes(std::uint8_t{200}) + bytes(-1.5f * static_cast<float>(i)) +
              bytes(static_cast<std::int16_t>(-300 - i));
    return data + bytes(std::uint8_t{9}) + bytes(std::uint16_t{3}) + bytes(2u) + bytes(1u) + bytes(0u);
  };
  const std::string ascii = "0.25 200 0 -300\n1.25 200 -1.5 -301\n\n 2.25\t200 -3e0 -302 \r\n9 3 2 1 0";
  const TriangleMesh meshes[] = {readPly(directory.write("a.ply", "ply\nformat ascii" + body + ascii)),
                                 readPly(directory.write("b.ply", "ply\r\nformat binary_little_endian" + body +
                                                                      binary([](auto v) { return bytesOf(v); }))),
                                 readPly(directory.write("c.ply", "ply\nformat binary_big_endian" + body +
                                                                      binary([](auto v) { return bigEndian(v); })))};
  for (const TriangleMesh& mesh : meshes) {
    EXPECT_EQ(mesh.vertices, (std::vector<Eigen::Vector3d>{{0, -300, 0.25}, {-1.5, -301, 1.25}, {-3, -302, 2.25}}));
    EXPECT_EQ(mesh.triangles, (std::vector<TriangleMesh::Triangle>{{2, 1, 0}}));
  }
}

TEST(Ply, WithLargerFacesIsReadAsFans) {
  const TemporaryDirectory directory;
  const TriangleMesh mesh = readPly(directory.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n4 4 3 2 "
      "1\n"));
  EXPECT_EQ(mesh.triangles,
            (std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 3, 2}, {4, 2, 1}}));
}

TEST(Ply, MayHaveOtherElementsAndListsAnywhere) {
  const TemporaryDirectory directory;
  const TriangleMesh mesh = readPly(directory.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement material 2\nproperty list uchar float colour\nproperty int id\nelement face 1\n"
      "property list uchar int vertex_indices\nproperty list uchar float texcoord\nelement edge 0\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nproperty list int int friends\nelement tail 1\n"
      "property char a\nend_header\n3 .1 .2 .3 7\n0 8\n3 0 1 2 2 .5 .5\n0 0 0 0\n1 0 0 2 4 5\n0 1 0 1 9\n-5\n"));
  EXPECT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.triangles, (std::vector<TriangleMesh::Triangle>{{0, 1, 2}}));
}

TEST(Ply, IsNotWrittenWithAFault) {
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.write("mesh.ply", "mine");
  TriangleMesh mesh = randomMesh(3, 1);
  mesh.triangles[0][2] = 3;
  EXPECT_THROW(writePly(path, mesh), std::invalid_argument);
  mesh = randomMesh(3, 1);
  mesh.vertices[1].x() = std::nan("");
  EXPECT_THROW(writePly(path, mesh), std::invalid_argument);
  mesh.vertices[1].x() = 1e39;
  EXPECT_THROW(writePly(path, mesh, PlyPrecision::Float), std::invalid_argument);
  EXPECT_EQ(contents(path), "mine");
  EXPECT_THROW(writePly(directory.path() / "none" / "mesh.ply", mesh), FileError);
  writePly(path, mesh);
  EXPECT_EQ(readPly(path).vertices, mesh.vertices);
}

}  // namespace
}  // namespace gaussmap
