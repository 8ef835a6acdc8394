// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/ply/ply_header.h"

namespace gaussmap::detail {

/// The vertices of a PLY file: one number per vertex and property. Elements before and behind are skipped.
class PlyVertices {
 public:
  /// Finds the vertices and checks that the file can hold them. `bytes` is the whole file, which must stay in memory,
  /// and `header` its header. Throws FileError if there is no element vertex, or if the file is too short.
  PlyVertices(const std::filesystem::path& path, PlyHeader header, std::string_view bytes);

  std::size_t size() const { return vertex().count; }
  const PlyElement& vertex() const { return header_.elements[vertex_]; }
  PlyEncoding encoding() const { return header_.encoding; }
  /// Returns true if the file has an element of this name with at least one entry.
  bool hasElement(std::string_view name) const;
  /// Returns the number of faces; 0: the file is not a mesh.
  std::size_t faces() const;
  /// Returns true if all vertices have the same number of bytes, so that decode() can be used: the file is binary, and
  /// the vertices have no lists.
  bool hasRecords() const { return record_size_ > 0; }
  /// Returns the number of bytes behind the vertices if hasRecords() and no element follows; else 0.
  std::size_t bytesBehind() const;
  std::size_t recordSize() const { return record_size_; }

  /// Decodes a property of the vertices from `first` on. Only if hasRecords(); the property must not be a list.
  void decode(std::size_t property, std::size_t first, std::size_t count, double* values) const;
  /// Returns properties of all vertices. The numbers of the properties must be ascending, and none may be a list.
  /// Each call reads the file once. Throws FileError with the line or the byte if the data are damaged.
  std::vector<std::vector<double>> columns(const std::vector<std::size_t>& properties) const;

 private:
  std::vector<std::vector<double>> walkedColumns(const std::vector<std::size_t>& properties) const;

  std::filesystem::path path_;
  PlyHeader header_;
  std::string_view bytes_;
  std::size_t vertex_ = 0;           // number of the element
  std::size_t first_ = 0;            // place of the first vertex in a binary file [bytes]
  std::size_t record_size_ = 0;      // bytes per vertex; 0: the size varies
  std::vector<std::size_t> places_;  // of the properties in a record [bytes]
};

}  // namespace gaussmap::detail
