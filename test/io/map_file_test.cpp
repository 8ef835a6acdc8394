// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/map_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <functional>
#include <iterator>

#include "gaussmap/io/error.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/map_equality.h"
#include "io/temporary_directory.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using test::expectSameMap;
using test::randomCloud;
using test::sameMap;
using test::TemporaryDirectory;

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no FileError";
  return "";
}

void expectRefused(const fs::path& path, const std::string& why) {
  for (const std::string& message : {messageOf([&] { loadMap<3>(path); }), messageOf([&] { loadMetadata(path); })}) {
    EXPECT_EQ(message.find(path.string() + ": "), 0u) << message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
  }
}

template <int D>
GaussianMap<D> refined(const GaussianMap<D>& map) {
  RefineOptions options;
  options.budget = 2.5;
  return refine<D>(map, options);
}

/// The same Gaussians at the finest scale, but no moments to grow from.
template <int D>
GaussianMap<D> finalised(const GaussianMap<D>& map) {
  MapScale<D> finest;
  finest.keys = map.scale(0).keys;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) finest.gaussians.push_back(map.localGaussian(i, 0));
  return build<D>(finest, map.options());
}

template <int D>
std::vector<Vector<D>> shifted(std::vector<Vector<D>> points, double shift) {
  for (Vector<D>& point : points)
    for (int axis = 0; axis < D; ++axis) point(axis) += axis % 2 == 0 ? shift : -shift;
  return points;
}

/// A map small enough for thousands of loads, with several tiles at two scales and several Gaussians in its cells.
GaussianMapOctree smallMap() {
  return refined<3>(build<3>(randomCloud<3>(150, 31), {0.1, 4, 3, 0.0}));
}

class MapFile : public testing::Test {
 protected:
  template <int D>
  void expectRoundTrip(const GaussianMap<D>& map) {
    const fs::path path = directory_.path() / "map.gmap";
    saveMap<D>(map, path, {}, {true, 3, 0});
    expectSameMap<D>(loadMap<D>(path), map);
  }
  std::vector<std::string> namesInFolder() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(directory_.path())) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryDirectory directory_;
};

// ---- what goes in comes out -----------------------------------------------------------------------------------------

TEST_F(MapFile, GivesBackEveryBitInSpace) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 21), {0.1, ratio, 3, 0.004});
    expectRoundTrip<3>(map);
    expectRoundTrip<3>(refined<3>(map));
    expectRoundTrip<3>(finalised<3>(map));
    expectRoundTrip<3>(refined<3>(finalised<3>(map)));
  }
}

TEST_F(MapFile, GivesBackEveryBitInThePlane) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapQuadtree map = build<2>(randomCloud<2>(3000, 22), {0.07, ratio, 4, 0.0});
    expectRoundTrip<2>(map);
    expectRoundTrip<2>(refined<2>(map));
    expectRoundTrip<2>(finalised<2>(map));
  }
}

TEST_F(MapFile, GivesBackMapsOfOneScaleOnePointAndNothing) {
  expectRoundTrip<3>(build<3>(randomCloud<3>(500, 23), {0.1, 10, 1, 0.0}));
  expectRoundTrip<3>(build<3>({{-0.05, 7.3, -1e-9}}, {0.1, 10, 3, 0.0}));
  expectRoundTrip<3>(GaussianMapOctree({0.3, 7, 4, 0.01}));
  expectRoundTrip<2>(GaussianMapQuadtree({0.3, 2, 9, 0.0}));
  expectRoundTrip<3>(GaussianMapOctree({0.3, 2, 1, 0.0}));
}

TEST_F(MapFile, GivesBackNegativeAndFarCells) {
  for (const double shift : {-50.0, 1e7, -1e7}) {
    const GaussianMapOctree map = build<3>(shifted<3>(randomCloud<3>(1000, 24), shift), {0.1, 10, 3, 0.0});
    expectRoundTrip<3>(map);
    expectRoundTrip<3>(refined<3>(map));
  }
}

TEST_F(MapFile, GivesBackTheOutermostCells) {  // keys -2^31 and 2^31 - 1
  expectRoundTrip<3>(
      build<3>({{-2147483648.0, 2147483647.5, 0.0}, {2147483647.5, -2147483648.0, 1.0}}, {1.0, 10, 3, 0.0}));
}

TEST_F(MapFile, GivesBackALatticeThatCompressesToAlmostNothing) {  // one point in the middle of every cell
  std::vector<Vector<3>> points;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y)
      for (int z = 0; z < 10; ++z) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  const GaussianMapOctree map = build<3>(points, {1.0, 10, 2, 0.0});
  ASSERT_EQ(map.cellCount(0), 100000u);
  for (const int level : {1, 3, 19}) {
    const fs::path path = directory_.path() / "lattice.gmap";
    saveMap<3>(map, path, {}, {true, level, 0});
    expectSameMap<3>(loadMap<3>(path), map);
  }
}

TEST_F(MapFile, SaysHowLargeItsPartsAre) {
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
  const MapFileSize size = mapFileSize(path);
  EXPECT_EQ(size.file, fs::file_size(path));
  ASSERT_EQ(size.scale_tiles.size(), 3u);
  std::uintmax_t tiles = 0;
  for (const std::uintmax_t bytes : size.scale_tiles) {
    EXPECT_GT(bytes, 0u);
    tiles += bytes;
  }
  EXPECT_LT(tiles, size.file);
}

// ---- the file -------------------------------------------------------------------------------------------------------

TEST_F(MapFile, HasTheSameBytesForTheSameMapAndAnyThreads) {
  const GaussianMapOctree map = refined<3>(build<3>(randomCloud<3>(5000, 25), {0.02, 10, 3, 0.0}));
  const MapMetadata metadata = {{"history", "[1]"}, {"crs", "EPSG:25832"}};
  std::vector<std::string> files;
  for (const int threads : {1, 2, 0, 1}) {
    const fs::path path = directory_.path() / ("map" + std::to_string(files.size()));
    saveMap<3>(map, path, metadata, {false, 3, threads});
    files.push_back(bytesOf(path));
  }
  for (const std::string& file : files) EXPECT_TRUE(file == files.front());
}

TEST_F(MapFile, KeepsAnExistingFileUnlessToldOtherwise) {
  const fs::path path = directory_.write("map.gmap", "mine");
  const std::string message = messageOf([&] { saveMap<3>(smallMap(), path); });
  EXPECT_NE(message.find("exists already"), std::string::npos) << message;
  EXPECT_EQ(bytesOf(path), "mine");
  saveMap<3>(smallMap(), path, {}, {true, 3, 0});
  expectSameMap<3>(loadMap<3>(path), smallMap());
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

TEST_F(MapFile, KeepsMetadataWhateverTheirNames) {
  const MapMetadata metadata = {{"scales", "not the number of scales"},
                                {"resolution", ""},
                                {"", "no name"},
                                {"user.scales", "nested"},
                                {"Stra\u00dfe", "Gr\u00fc\u00dfe, \u4e16\u754c \U0001F5FA"},
                                {"quote", "it's \"quoted\"; DROP TABLE tiles; --\n\t%s"},
                                {"zero", std::string("a\0b", 3)},
                                {"bytes", "\xff\xfe\x80"},
                                {"long", std::string(200000, 'x')}};
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path, metadata);
  EXPECT_EQ(loadMetadata(path), metadata);
  expectSameMap<3>(loadMap<3>(path), smallMap());
  saveMap<3>(smallMap(), directory_.path() / "bare.gmap");
  EXPECT_TRUE(loadMetadata(directory_.path() / "bare.gmap").empty());
}

TEST_F(MapFile, MayHaveAnyNameThatTheFileSystemTakes) {
  for (const char* const name :
       {"a b", "100%", "what?immutable=0", "#1", "stra\u00dfe.gmap", ":memory:", "file:x", "%41"}) {
    const fs::path path = directory_.path() / name;
    saveMap<3>(smallMap(), path);
    expectSameMap<3>(loadMap<3>(path), smallMap());
  }
  const fs::path before = fs::current_path();
  fs::current_path(directory_.path());
  EXPECT_NO_THROW(loadMap<3>(":memory:"));
  saveMap<3>(smallMap(), "relative.gmap");
  EXPECT_NO_THROW(loadMap<3>("relative.gmap"));
  fs::current_path(before);
}

TEST_F(MapFile, CannotBeMadeWhereNoFileCanBe) {
  EXPECT_THROW(saveMap<3>(smallMap(), directory_.path() / "missing" / "map.gmap"), FileError);
  EXPECT_THROW(saveMap<3>(smallMap(), directory_.path(), {}, {true, 3, 0}), FileError);
  EXPECT_THROW(saveMap<3>(smallMap(), directory_.path() / std::string(5000, 'x')), FileError);
  EXPECT_TRUE(namesInFolder().empty());
}

TEST_F(MapFile, ThatDoesNotFitTheDiskLeavesTheOldOne) {  // a limit on the size of files stands in for the disk
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
  const GaussianMapOctree large = build<3>(randomCloud<3>(20000, 26), {0.02, 10, 3, 0.0});
  struct rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit limit = before;
  limit.rlim_cur = 100000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    saveMap<3>(large, path, {}, {true, 3, 0});
  } catch (const FileError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("cannot be written"), std::string::npos) << message;
  expectSameMap<3>(loadMap<3>(path), smallMap());
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

// ---- other files ----------------------------------------------------------------------------------------------------

/// SQL on a database, as a user of the sqlite3 shell would give it; the last row of the answer.
std::vector<std::string> shell(const fs::path& path, const std::string& sql) {
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

TEST_F(MapFile, IsASoundDatabaseWithAnApplicationId) {
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
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
  saveMap<2>(build<2>(randomCloud<2>(100, 1), {}), path);
  const std::string message = messageOf([&] { loadMap<3>(path); });
  EXPECT_NE(message.find("dimension 2"), std::string::npos) << message;
  EXPECT_NO_THROW(loadMap<2>(path));
  EXPECT_NO_THROW(loadMetadata(path));
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
  expectRefused(directory_.write("text", "x y z\n1 2 3\n"), "is no map");
  expectRefused(directory_.write("short", "SQLite"), "is no map");
  expectRefused(directory_.write("picture", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + std::string(5000, '\3')),
                "is no map");
  expectRefused(directory_.write("magic", std::string("SQLite format 3\0", 16) + std::string(5000, '\3')),
                "is damaged");
  expectRefused(directory_.write("magic only", std::string("SQLite format 3\0", 16)), "is damaged");
  const fs::path other = directory_.path() / "other";
  shell(other, "CREATE TABLE tiles (zoom_level, tile_column, tile_row, tile_data)");
  expectRefused(other, "not a gaussmap map");
}

TEST_F(MapFile, OfAnotherVersionIsRefusedByItsNumber) {
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
  shell(path, "PRAGMA user_version = 2");
  expectRefused(path, "version 2");
}

// ---- damage ---------------------------------------------------------------------------------------------------------

TEST_F(MapFile, WithAnyRowChangedIsRefused) {
  const fs::path good = directory_.path() / "good.gmap", path = directory_.path() / "map.gmap";
  const GaussianMapOctree map = smallMap();
  saveMap<3>(map, good);
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
    EXPECT_THROW(loadMap<3>(path), FileError) << edit;
  }
}

TEST_F(MapFile, WithTilesSwappedIsRefused) {
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
  shell(path,
        "CREATE TEMP TABLE two AS SELECT rowid AS r, data FROM tiles WHERE scale = 0 LIMIT 2;"
        "UPDATE tiles SET data = (SELECT data FROM two WHERE r != tiles.rowid) WHERE rowid IN (SELECT r FROM two)");
  const std::string message = messageOf([&] { loadMap<3>(path); });
  EXPECT_NE(message.find("belongs to another place"), std::string::npos) << message;
}

TEST_F(MapFile, WithRowsThatMeanNothingToItIsTheSameMap) {
  const fs::path path = directory_.path() / "map.gmap";
  saveMap<3>(smallMap(), path);
  shell(path,
        "CREATE TABLE notes (text); INSERT INTO notes VALUES ('mine'); INSERT INTO metadata VALUES ('user.x', 'y');"
        "VACUUM");
  expectSameMap<3>(loadMap<3>(path), smallMap());
  EXPECT_EQ(loadMetadata(path), (MapMetadata{{"x", "y"}}));
}

/// True if the file loads as the map; false if it is refused. Anything else that is thrown fails the test.
bool loadsAsTheMap(const fs::path& path, const GaussianMapOctree& map) {
  try {
    loadMetadata(path);
    mapFileSize(path);
    if (!sameMap<3>(loadMap<3>(path), map)) ADD_FAILURE() << path << " loads as another map";
    return true;
  } catch (const FileError&) {
    return false;
  }
}

TEST_F(MapFile, CutShortIsRefused) {
  const GaussianMapOctree map = smallMap();
  const fs::path good = directory_.path() / "good.gmap";
  saveMap<3>(map, good);
  const std::string bytes = bytesOf(good);
  for (std::size_t length = 0; length < bytes.size(); length += length < 200 ? 1 : 97)
    EXPECT_FALSE(loadsAsTheMap(directory_.write("cut.gmap", bytes.substr(0, length)), map)) << length << " bytes";
  EXPECT_TRUE(loadsAsTheMap(directory_.write("whole.gmap", bytes), map));
  EXPECT_TRUE(loadsAsTheMap(directory_.write("longer.gmap", bytes + std::string(4096, 'x')), map));
}

TEST_F(MapFile, WithFlippedBytesIsTheSameMapOrRefused) {
  const GaussianMapOctree map = smallMap();
  const fs::path good = directory_.path() / "good.gmap", path = directory_.path() / "flipped.gmap";
  saveMap<3>(map, good);
  const std::string bytes = bytesOf(good);
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
  saveMap<3>(map, good);
  const std::string bytes = bytesOf(good);
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
  saveMap<3>(smallMap(), path);
  directory_.write("map.gmap-journal", std::string("\xd9\xd5\x05\xf9\x20\xa1\x63\xd7", 8) + std::string(600, '\1'));
  directory_.write("map.gmap-wal", std::string(600, '\1'));
  expectSameMap<3>(loadMap<3>(path), smallMap());
}

// ---- crashes --------------------------------------------------------------------------------------------------------

/// Saves two maps over one path in turn, for ever; a byte into the pipe after each save.
[[noreturn]] void saveForEver(const fs::path& path, const std::array<GaussianMapOctree, 2>& maps, int pipe) {
  for (std::size_t round = 0;; ++round) {
    try {
      saveMap<3>(maps[round % 2], path, {}, {true, 1, 1});
    } catch (...) {
      ::_exit(3);
    }
    if (::write(pipe, "s", 1) != 1) ::_exit(4);
  }
}

TEST_F(MapFile, SurvivesAKillInTheMiddleOfASave) {
  const std::array<GaussianMapOctree, 2> maps = {build<3>(randomCloud<3>(6000, 51), {0.05, 10, 3, 0.0}),
                                                 build<3>(randomCloud<3>(7000, 52), {0.05, 10, 3, 0.0})};
  const fs::path path = directory_.path() / "map.gmap", part = directory_.path() / "map.gmap.part";
  saveMap<3>(maps[0], path);
  Random random(53);
  int left_a_part = 0;
  for (int round = 0; round < 12; ++round) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) saveForEver(path, maps, pipe[1]);
    ::close(pipe[1]);
    char saved = 0;
    const std::uint64_t saves = 1 + random.below(4);
    for (std::uint64_t i = 0; i < saves; ++i) ASSERT_EQ(::read(pipe[0], &saved, 1), 1);
    if (round % 2 == 0) {  // in the middle for sure: the part file has grown to a size drawn by lot
      const std::uintmax_t size = random.below(fs::file_size(path));
      std::error_code none;
      for (std::uintmax_t now = 0; now == static_cast<std::uintmax_t>(-1) || now < size;
           now = fs::file_size(part, none))
        ASSERT_EQ(::waitpid(child, nullptr, WNOHANG), 0) << "the child ended by itself";
    } else {  // anywhere
      for (volatile std::uint64_t wait = random.below(20000000); wait > 0; wait = wait - 1) {
      }
    }
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    ::close(pipe[0]);

    left_a_part += fs::exists(part);
    const GaussianMapOctree found = loadMap<3>(path);
    EXPECT_TRUE(sameMap<3>(found, maps[0]) || sameMap<3>(found, maps[1])) << "round " << round;
  }
  EXPECT_GT(left_a_part, 0);  // else the test has proven nothing
  directory_.write("map.gmap.part", "stale");
  saveMap<3>(maps[1], path, {}, {true, 3, 0});
  expectSameMap<3>(loadMap<3>(path), maps[1]);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

}  // namespace
}  // namespace gaussmap
