// SPDX-License-Identifier: BSD-3-Clause
// A process that dies while it saves.
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>

#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

/// Saves two maps over one path in turn, for ever; a byte into the pipe after each save.
[[noreturn]] void saveForEver(const fs::path& path, const std::array<GaussianMapOctree, 2>& maps, int pipe) {
  for (std::size_t round = 0;; ++round) {
    try {
      save(path, maps[round % 2], {}, {true, 1, 1});
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
  save(path, maps[0]);
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
    const GaussianMapOctree found = load(path);
    EXPECT_TRUE(sameMap<3>(found, maps[0]) || sameMap<3>(found, maps[1])) << "round " << round;
  }
  EXPECT_GT(left_a_part, 0);  // else the test has proven nothing
  directory_.write("map.gmap.part", "stale");
  save(path, maps[1], {}, {true, 3, 0});
  expectSameMap<3>(load(path), maps[1]);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

}  // namespace
}  // namespace gaussmap::test
