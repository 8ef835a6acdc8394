// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Reads the triangles of a PLY file 1.0 (ascii, binary of either byte order): x, y, z of the element `vertex` [m] as
/// any number, the list `vertex_indices` or `vertex_index` of the element `face` as any whole number. Faces of more
/// than three corners become a fan round their first one. All else is skipped. No file makes it crash, hang, or ask for
/// more memory than a small multiple of the file's size.
/// Throws FileError, with the line or the byte: no PLY file, one without faces (a point cloud), a header that does not
/// fit the size of the file, data cut off, a vertex that is not finite, an index out of range, a face of less than
/// three corners.
GAUSSMAP_API TriangleMesh readPly(const std::filesystem::path& path);

enum class PlyPrecision {
  Float,  ///< what every viewer takes; resolves 4 mm at 65 km from the origin
  Double  ///< exact
};

/// Writes a binary little-endian PLY file, whole or not at all (AtomicFile). The same mesh gives the same bytes.
/// Throws std::invalid_argument if the mesh has a fault (see checkMesh()) or a coordinate is too large for a float;
/// FileError if the file cannot be written.
GAUSSMAP_API void writePly(const std::filesystem::path& path, const TriangleMesh& mesh,
                           PlyPrecision precision = PlyPrecision::Double);

}  // namespace gaussmap
