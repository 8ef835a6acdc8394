// SPDX-License-Identifier: BSD-3-Clause
// Map files with changed rows, bytes and pages.
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(MapFile, WithAnyRowChangedIsRefused) {
  const fs::path good = directory_.path() / "good.gmap", path = directory_.path() / "map.gmap";
  const GaussianMapOctree map = smallMap();
  save(good, map);
  const std::string first_tile = " WHERE rowid = (SELECT MIN(rowid) FROM tiles WHERE scale = 0)";
  const std::string last_tile = " WHERE rowid = (SELECT MAX(rowid) FROM tiles WHERE scale = 0)";
  const auto setMetadata = [](const std::string& name, const std::string& value) {
    return "UPDATE metadata SET value = '" + value + "' WHERE name = '" + name + "'";
  };
  const std::vector<std::string> edits = {
      "UPDATE tiles SET x = x + 1000" + first_tile,
      "UPDATE tiles SET x = x + 4294967296" + first_tile,
      "UPDATE tiles SET z = 77" + last_tile,
      "UPDATE tiles SET x = 'here'" + first_tile,
      "UPDATE tiles SET scale = 1, x = 99" + first_tile,
      "UPDATE tiles SET scale = 63" + first_tile,
      "DELETE FROM tiles" + first_tile,
      "DELETE FROM tiles WHERE scale = 2",
      "DELETE FROM tiles",
      "DELETE FROM metadata",
      "INSERT INTO tiles SELECT scale, x + 4294967296, y, z, cells, gaussians, data FROM tiles" + first_tile,
      "INSERT INTO tiles SELECT scale, x + 1000, y, z, cells, gaussians, data FROM tiles" + first_tile,
      "UPDATE tiles SET data = x''" + first_tile,
      "UPDATE tiles SET data = 'text'" + first_tile,
      "UPDATE tiles SET data = 12" + first_tile,
      "UPDATE tiles SET data = zeroblob(100000)" + first_tile,
      "UPDATE tiles SET data = substr(data, 1, length(data) - 1)" + first_tile,
      "UPDATE tiles SET data = data || x'00'" + first_tile,
      "UPDATE tiles SET data = (SELECT data FROM tiles" + last_tile + ")" + first_tile,
      "DROP TABLE tiles",
      "DROP TABLE metadata",
      "ALTER TABLE tiles RENAME COLUMN data TO bytes",
      "DROP TABLE tiles; CREATE VIEW tiles AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)"
      " SELECT 0 AS scale, x, 0 AS y, 0 AS z, 1 AS cells, 1 AS gaussians, 5 AS data FROM n",
      "DROP TABLE metadata; CREATE VIEW metadata AS WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)"
      " SELECT x AS name, x AS value FROM n",
      "DROP TABLE tiles; CREATE VIEW tiles AS SELECT 0 AS scale, 0 AS x, 0 AS y, 0 AS z, zeroblob(900000000) AS data",
      setMetadata("resolution", "0.2"),
      setMetadata("resolution", "0.1000000000000001"),
      setMetadata("resolution", "nan"),
      setMetadata("resolution", "1e999"),
      setMetadata("resolution", "0.1 "),
      setMetadata("resolution", ""),
      setMetadata("resolution", "-1"),
      setMetadata("noise", "0.1"),
      setMetadata("noise", "0"),
      setMetadata("ratio", "5"),
      setMetadata("ratio", "1"),
      setMetadata("ratio", "2147483647"),
      setMetadata("ratio", "99999999999"),
      setMetadata("scales", "2"),
      setMetadata("scales", "4"),
      setMetadata("scales", "0"),
      setMetadata("scales", "-1"),
      setMetadata("scales", "2000000000"),
      setMetadata("dimension", "2"),
      setMetadata("dimension", "7"),
      setMetadata("cells.0", "1"),
      setMetadata("cells.2", "18446744073709551615"),
      "DELETE FROM metadata WHERE name = 'noise'",
      "DELETE FROM metadata WHERE name = 'cells.1'",
  };
  for (const std::string& edit : edits) {
    fs::copy_file(good, path, fs::copy_options::overwrite_existing);
    shell(path, edit);
    EXPECT_THROW(load(path), FileError) << edit;
  }
}

TEST_F(MapFile, WithTilesSwappedIsRefused) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  shell(path,
        "CREATE TEMP TABLE two AS SELECT rowid AS r, data FROM tiles WHERE scale = 0 LIMIT 2;"
        "UPDATE tiles SET data = (SELECT data FROM two WHERE r != tiles.rowid) WHERE rowid IN (SELECT r FROM two)");
  const std::string message = complaintOf([&] { load(path); });
  EXPECT_NE(message.find("belongs to another place"), std::string::npos) << message;
}

TEST_F(MapFile, WithRowsThatMeanNothingToItIsTheSameMap) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  shell(path,
        "CREATE TABLE notes (text); INSERT INTO notes VALUES ('mine'); INSERT INTO metadata VALUES ('user.x', 'y');"
        "VACUUM");
  expectSameMap<3>(load(path), smallMap());
  EXPECT_EQ(loadMetadata(path), (MapMetadata{{"x", "y"}}));
}

/// True if the file loads as the map; false if it is refused. Anything else that is thrown fails the test.
bool loadsAsTheMap(const fs::path& path, const GaussianMapOctree& map) {
  try {
    loadMetadata(path);
    mapFileSize(path);
    if (!sameMap<3>(load(path), map)) ADD_FAILURE() << path << " loads as another map";
    return true;
  } catch (const FileError&) {
    return false;
  }
}

TEST_F(MapFile, CutShortIsRefused) {
  const GaussianMapOctree map = smallMap();
  const fs::path good = directory_.path() / "good.gmap";
  save(good, map);
  const std::string bytes = contentsOf(good);
  for (std::size_t length = 0; length < bytes.size(); length += length < 200 ? 1 : 97)
    EXPECT_FALSE(loadsAsTheMap(directory_.write("cut.gmap", bytes.substr(0, length)), map)) << length << " bytes";
  EXPECT_TRUE(loadsAsTheMap(directory_.write("whole.gmap", bytes), map));
  EXPECT_TRUE(loadsAsTheMap(directory_.write("longer.gmap", bytes + std::string(4096, 'x')), map));
}

TEST_F(MapFile, WithFlippedBytesIsTheSameMapOrRefused) {
  const GaussianMapOctree map = smallMap();
  const fs::path good = directory_.path() / "good.gmap", path = directory_.path() / "flipped.gmap";
  save(good, map);
  const std::string bytes = contentsOf(good);
  Random random(41);
  int refused = 0, same = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string flipped = bytes;
    // One byte anywhere, or in the header and the first page, where the tables are described; sometimes a handful.
    const std::size_t range = round % 4 == 0 ? 100 : round % 4 == 1 ? 4096 : bytes.size();
    const std::uint64_t flips = round % 8 == 7 ? 2 + random.below(20) : 1;
    for (std::uint64_t i = 0; i < flips; ++i) flipped[random.below(range)] = static_cast<char>(random.below(256));
    directory_.write("flipped.gmap", flipped);
    ++(loadsAsTheMap(path, map) ? same : refused);
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(same, 100);  // free bytes of a page, and the same byte again
  EXPECT_EQ(namesInFolder(), (std::vector<std::string>{"flipped.gmap", "good.gmap"}));  // no journals made by reading
}

TEST_F(MapFile, WithPagesCopiedOverOthersIsTheSameMapOrRefused) {  // makes rings of pages, and rows there twice
  const GaussianMapOctree map = smallMap();
  const fs::path good = directory_.path() / "good.gmap", path = directory_.path() / "mixed.gmap";
  save(good, map);
  const std::string bytes = contentsOf(good);
  const std::size_t pages = bytes.size() / 4096;
  ASSERT_GT(pages, 6u);
  Random random(42);
  for (int round = 0; round < 500; ++round) {
    std::string mixed = bytes;
    const std::size_t from = 1 + random.below(pages - 1), to = 1 + random.below(pages - 1);
    mixed.replace(to * 4096, 4096, bytes, from * 4096, 4096);
    directory_.write("mixed.gmap", mixed);
    loadsAsTheMap(path, map);
    if (HasFailure()) FAIL() << "page " << from << " over page " << to;
  }
}

TEST_F(MapFile, IsReadWithoutRegardForJournalsBesideIt) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  directory_.write("map.gmap-journal", std::string("\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", 8) + std::string(600, '\1'));
  directory_.write("map.gmap-wal", std::string(600, '\1'));
  expectSameMap<3>(load(path), smallMap());
}

}  // namespace
}  // namespace gaussmap::test
