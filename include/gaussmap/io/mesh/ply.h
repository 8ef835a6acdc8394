// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Reads the triangles of a PLY file (version 1.0; ascii, or binary of either byte order).
///
/// The function reads x, y, z of the element `vertex` [m] as numbers of any type. It reads the list `vertex_indices` or
/// `vertex_index` of the element `face` as integers of any type. A face with more than three corners becomes a fan
/// around its first corner. Everything else is skipped. No file can make the function crash, hang, or use more memory
/// than a small multiple of the file's size.
///
/// Throws FileError, with the line or the byte, in these cases:
/// - The file is not a PLY file, or it has no faces (a point cloud).
/// - The header does not fit the size of the file, or the data are truncated.
/// - A vertex is not finite, an index is out of range, or a face has less than three corners.
GAUSSMAP_API TriangleMesh readPly(const std::filesystem::path& path);

/// The type of the coordinates in a PLY file.
enum class PlyPrecision {
  Float,  ///< for any viewer; rounds to steps of 4 mm at 65 km from the origin
  Double  ///< exact
};

/// Writes a mesh to a binary little-endian PLY file. The write is atomic, and the same mesh gives the same bytes.
/// Throws std::invalid_argument if the mesh has a fault (see checkMesh()) or a coordinate is too large for a float, and
/// FileError if the file cannot be written.
GAUSSMAP_API void writePly(const std::filesystem::path& path, const TriangleMesh& mesh,
                           PlyPrecision precision = PlyPrecision::Double);

}  // namespace gaussmap
