// SPDX-License-Identifier: BSD-3-Clause
// Map files for others to read, and files of others.
#include <sys/stat.h>

#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(MapFile, IsASoundDatabaseWithAnApplicationId) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  EXPECT_EQ(shell(path, "PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  EXPECT_EQ(shell(path, "PRAGMA application_id"), std::vector<std::string>{"1735221616"});  // "gmap"
  EXPECT_EQ(shell(path, "PRAGMA user_version"), std::vector<std::string>{"1"});
  EXPECT_EQ(shell(path, "SELECT value FROM metadata WHERE name = 'resolution'"), std::vector<std::string>{"0.1"});
  for (int s = 0; s < 3; ++s) {
    const std::string scale = std::to_string(s);
    EXPECT_EQ(shell(path, "SELECT SUM(cells), SUM(gaussians) FROM tiles WHERE scale = " + scale),
              (std::vector<std::string>{std::to_string(smallMap().cellCount(s)),
                                        std::to_string(smallMap().gaussianCount(s))}));
  }
  EXPECT_GT(std::stoi(shell(path, "SELECT COUNT(*) FROM tiles WHERE scale = 0").at(0)), 1);
}

TEST_F(MapFile, OfAnotherDimensionIsRefused) {
  const fs::path path = directory_.path() / "map.gmap";
  save<2>(path, build<2>(randomCloud<2>(100, 1), {}));
  const std::string message = complaintOf([&] { load(path); });
  EXPECT_NE(message.find("dimension 2"), std::string::npos) << message;
  EXPECT_NO_THROW(load<2>(path));
  EXPECT_NO_THROW(loadMetadata(path));
}

TEST_F(MapFile, TellsItsDimensions) {
  const fs::path path = directory_.path() / "map.gmap";
  save<2>(path, build<2>(randomCloud<2>(100, 1), {}));
  EXPECT_EQ(mapDimensions(path), 2);
  save(path, smallMap(), {}, {true, 3, 0});
  EXPECT_EQ(mapDimensions(path), 3);
  shell(path, "UPDATE metadata SET value = '4' WHERE name = 'dimension'");
  const std::string message = complaintOf([&] { mapDimensions(path); });
  EXPECT_NE(message.find("map.gmap: holds a map of dimension 4, expected 2 or 3"), std::string::npos) << message;
  EXPECT_THROW(mapDimensions(directory_.path() / "missing.gmap"), FileError);
  EXPECT_THROW(mapDimensions(directory_.write("text.gmap", "not a map")), FileError);
}

TEST_F(MapFile, MustBeThereAndAFile) {
  expectRefused(directory_.path() / "missing.gmap", "does not exist");
  expectRefused(directory_.path(), "is not a file");
  ASSERT_EQ(::mkfifo((directory_.path() / "pipe").c_str(), 0600), 0);
  expectRefused(directory_.path() / "pipe", "is not a file");
  EXPECT_THROW(mapFileSize(directory_.path() / "missing.gmap"), FileError);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"pipe"});  // reading makes no files
}

TEST_F(MapFile, MustBeAMap) {
  expectRefused(directory_.write("empty", ""), "is empty");
  expectRefused(directory_.write("text", "x y z\n1 2 3\n"), "is not a map");
  expectRefused(directory_.write("short", "SQLite"), "is not a map");
  expectRefused(directory_.write("picture", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + std::string(5000, '\3')),
                "is not a map");
  expectRefused(directory_.write("magic", std::string("SQLite format 3\0", 16) + std::string(5000, '\3')),
                "is damaged");
  expectRefused(directory_.write("magic only", std::string("SQLite format 3\0", 16)), "is damaged");
  const fs::path other = directory_.path() / "other";
  shell(other, "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)");
  expectRefused(other, "not a gaussmap map");
}

TEST_F(MapFile, OfAnotherVersionIsRefusedByItsNumber) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  shell(path, "PRAGMA user_version = 2");
  expectRefused(path, "version 2");
}

}  // namespace
}  // namespace gaussmap::test
