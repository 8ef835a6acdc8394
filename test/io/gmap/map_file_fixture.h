// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"

namespace gaussmap::test {
template <int D>
GaussianMap<D> refined(const GaussianMap<D>& map) {
  return refine<D>(map, PerCell{2.5}).map;
}

/// Returns a map that is small enough for thousands of loads, with several tiles at two scales and several Gaussians
/// per cell.
inline GaussianMapOctree smallMap() {
  return refined<3>(build<3>(randomCloud<3>(150, 31), {0.1, 4, 3, 0.0}));
}

/// Runs SQL on a database like the sqlite3 shell. Returns the last row of the answer.
inline std::vector<std::string> shell(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* handle = nullptr;
  EXPECT_EQ(sqlite3_open(path.c_str(), &handle), SQLITE_OK);
  std::vector<std::string> row;
  const auto take = [](void* to, int columns, char** values, char**) {
    auto& out = *static_cast<std::vector<std::string>*>(to);
    out.clear();
    for (int i = 0; i < columns; ++i) out.emplace_back(values[i] ? values[i] : "");
    return 0;
  };
  char* error = nullptr;
  EXPECT_EQ(sqlite3_exec(handle, sql.c_str(), take, &row, &error), SQLITE_OK) << sql << ": " << (error ? error : "");
  sqlite3_free(error);
  sqlite3_close(handle);
  return row;
}

/// Tests with files in their own directory.
class MapFile : public testing::Test {
 protected:
  template <int D>
  void expectRoundTrip(const GaussianMap<D>& map) {
    const std::filesystem::path path = directory_.path() / "map.gmap";
    save<D>(path, map, {}, {true, 3, 0});
    expectSameMap<D>(load<D>(path), map);
  }
  static void expectRefused(const std::filesystem::path& path, const std::string& why) {
    expectComplaint(complaintOf([&] { load(path); }), path, {why});
    expectComplaint(complaintOf([&] { loadMetadata(path); }), path, {why});
  }
  std::vector<std::string> namesInFolder() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory_.path()))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryDirectory directory_;
};

}  // namespace gaussmap::test
