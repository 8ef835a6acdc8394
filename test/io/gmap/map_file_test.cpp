// SPDX-License-Identifier: BSD-3-Clause
// Map files: names, metadata, bytes, replacing.
#include <sys/resource.h>

#include <csignal>

#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(MapFile, HasTheSameBytesForTheSameMapAndAnyThreads) {
  const GaussianMapOctree map = refined<3>(build<3>(randomCloud<3>(5000, 25), {0.02, 10, 3, 0.0}));
  const MapMetadata metadata = {{"history", "[1]"}, {"crs", "EPSG:25832"}};
  std::vector<std::string> files;
  for (const int threads : {1, 2, 0, 1}) {
    const fs::path path = directory_.path() / ("map" + std::to_string(files.size()));
    save(path, map, metadata, {false, 3, threads});
    files.push_back(contentsOf(path));
  }
  for (const std::string& file : files) EXPECT_TRUE(file == files.front());
}

TEST_F(MapFile, KeepsAnExistingFileUnlessToldOtherwise) {
  const fs::path path = directory_.write("map.gmap", "mine");
  const std::string message = complaintOf([&] { save(path, smallMap()); });
  EXPECT_NE(message.find("exists already"), std::string::npos) << message;
  EXPECT_EQ(contentsOf(path), "mine");
  save(path, smallMap(), {}, {true, 3, 0});
  expectSameMap<3>(load(path), smallMap());
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
  save(path, smallMap(), metadata);
  EXPECT_EQ(loadMetadata(path), metadata);
  expectSameMap<3>(load(path), smallMap());
  save(directory_.path() / "bare.gmap", smallMap());
  EXPECT_TRUE(loadMetadata(directory_.path() / "bare.gmap").empty());
}

TEST_F(MapFile, MayHaveAnyNameThatTheFileSystemTakes) {
  for (const char* const name :
       {"a b", "100%", "what?immutable=0", "#1", "stra\u00dfe.gmap", ":memory:", "file:x", "%41"}) {
    const fs::path path = directory_.path() / name;
    save(path, smallMap());
    expectSameMap<3>(load(path), smallMap());
  }
  const fs::path before = fs::current_path();
  fs::current_path(directory_.path());
  EXPECT_NO_THROW(load(":memory:"));
  save("relative.gmap", smallMap());
  EXPECT_NO_THROW(load("relative.gmap"));
  fs::current_path(before);
}

TEST_F(MapFile, CannotBeMadeWhereNoFileCanBe) {
  EXPECT_THROW(save(directory_.path() / "missing" / "map.gmap", smallMap()), FileError);
  EXPECT_THROW(save(directory_.path(), smallMap(), {}, {true, 3, 0}), FileError);
  EXPECT_THROW(save(directory_.path() / std::string(5000, 'x'), smallMap()), FileError);
  EXPECT_TRUE(namesInFolder().empty());
}

TEST_F(MapFile, ThatDoesNotFitTheDiskLeavesTheOldOne) {  // a limit on the size of files stands in for the disk
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  const GaussianMapOctree large = build<3>(randomCloud<3>(20000, 26), {0.02, 10, 3, 0.0});
  struct rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit limit = before;
  limit.rlim_cur = 100000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    save(path, large, {}, {true, 3, 0});
  } catch (const FileError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("cannot be written"), std::string::npos) << message;
  expectSameMap<3>(load(path), smallMap());
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

}  // namespace
}  // namespace gaussmap::test
