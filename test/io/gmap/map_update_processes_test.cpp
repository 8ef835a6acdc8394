// SPDX-License-Identifier: BSD-3-Clause
// Updates beside readers, and updates that are killed.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <limits>

#include "gaussmap/io/gmap/map_reader.h"
#include "gaussmap/io/gmap/map_update.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

const MapOptions kOptions{0.05, 5, 3, 0.0};

/// Starts a process that does this.
template <typename Action>
pid_t start(const Action& action) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  try {
    action();
  } catch (...) {
    ::_exit(3);
  }
  ::_exit(0);
}

UpdateOptions oneThread() {
  UpdateOptions options;
  options.threads = 1;  // the threads of the parent are not there after a fork
  return options;
}

TEST_F(MapFile, SeesTheOldOrTheNewTilesBesideAWriter) {
  constexpr int kUpdates = 12;
  const fs::path path = directory_.path() / "map.gmap";
  std::vector<MomentGrid<3>> added;
  std::vector<Vector<3>> points = randomCloud<3>(3000, 101);
  std::vector<GaussianMapOctree> versions = {build<3>(points, kOptions)};
  for (int i = 0; i < kUpdates; ++i) {
    const auto more = randomCloud<3>(1000, 102 + static_cast<std::uint64_t>(i));
    added.emplace_back(kOptions.resolution);
    added.back().addPoints(more);
    points.insert(points.end(), more.begin(), more.end());
    versions.push_back(build<3>(points, kOptions));
  }
  const Box<3> box{Vector<3>::Constant(-1.0), Vector<3>::Constant(1.0)};
  std::vector<GaussianMapOctree> parts;  // of each version
  const fs::path other = directory_.path() / "other.gmap";
  for (const GaussianMapOctree& version : versions) {
    save(other, version, {}, {true, 1, 1});
    parts.push_back(MapReader<3>(other).load(box));
  }
  fs::remove(other);
  save(path, versions[0]);

  int tokens[2];  // one for each update, when the version before has been seen
  ASSERT_EQ(::pipe(tokens), 0);
  const pid_t writer = start([&] {
    ::close(tokens[1]);  // so that it ends with the reader
    char token = 0;
    for (const MomentGrid<3>& grid : added) {
      if (::read(tokens[0], &token, 1) != 1) throw std::runtime_error("no token");
      updateMap<3>(path, grid, oneThread());
    }
  });
  ASSERT_GT(writer, 0);
  MapReader<3> reader(path, {0, 1});  // without a cache: every load goes to the file
  std::size_t version = 0;
  ::close(tokens[0]);
  const auto goOn = [&] { EXPECT_EQ(::write(tokens[1], "", 1), 1); };
  goOn();
  bool ended = false;
  for (int status = 0; !ended;) {
    ended = ::waitpid(writer, &status, WNOHANG) == writer;
    EXPECT_TRUE(!ended || (WIFEXITED(status) && WEXITSTATUS(status) == 0));
    if (reader.refresh()) {
      const GaussianMapOctree part = reader.load(box);
      ASSERT_LT(++version, parts.size());
      ASSERT_TRUE(sameMap<3>(part, parts[version])) << "not the next version";
      if (version < std::size_t{kUpdates}) goOn();
    }
    ASSERT_TRUE(sameMap<3>(reader.load(box), parts[version]));
  }
  ::close(tokens[1]);
  if (reader.refresh()) ++version;  // the last may have come with the writer's end
  EXPECT_EQ(version, std::size_t{kUpdates});
  EXPECT_TRUE(sameMap<3>(reader.load(box), parts.back()));
  expectSameMap<3>(load(path), versions.back());
}

TEST_F(MapFile, SurvivesAKillInTheMiddleOfAnUpdate) {
  const fs::path path = directory_.path() / "map.gmap", part = directory_.path() / "map.gmap.part";
  const auto points = randomCloud<3>(20000, 121), more = randomCloud<3>(5000, 122);
  const GaussianMapOctree old = refined<3>(build<3>(points, {0.02, 5, 3, 0.0}));
  MomentGrid<3> added(0.02);
  added.addPoints(more);
  save(path, old);
  const std::string bytes = contentsOf(path);
  const auto update = [&] { updateMap<3>(path, added, oneThread()); };

  // How long an update takes, in looks at the process; and what it makes.
  std::uint64_t duration = 0;
  const pid_t first = start(update);
  ASSERT_GT(first, 0);
  for (int status = 0; ::waitpid(first, &status, WNOHANG) == 0;) ++duration;
  const GaussianMapOctree fresh = load(path);
  ASSERT_FALSE(sameMap<3>(old, fresh));

  Random random(123);
  int killed = 0, left_a_part = 0;
  for (int round = 0; round < 20; ++round) {
    directory_.write("map.gmap", bytes);
    const pid_t child = start(update);
    ASSERT_GT(child, 0);
    int status = 0;
    bool ended = false;
    if (round % 2 == 0) {  // in the middle for sure: the part file is there
      std::error_code none;
      while (!ended && !fs::exists(part, none)) ended = ::waitpid(child, &status, WNOHANG) == child;
    }
    for (std::uint64_t wait = random.below(duration + duration / 10 + 1); !ended && wait > 0; --wait)
      ended = ::waitpid(child, &status, WNOHANG) == child;
    if (!ended) {
      ASSERT_EQ(::kill(child, SIGKILL), 0);
      ASSERT_EQ(::waitpid(child, &status, 0), child);
    }
    killed += WIFSIGNALED(status);
    left_a_part += fs::exists(part);
    const GaussianMapOctree found = load(path);
    EXPECT_TRUE(sameMap<3>(found, fresh) || (WIFSIGNALED(status) && sameMap<3>(found, old))) << "round " << round;
    EXPECT_EQ(shell(path, "PRAGMA integrity_check"), std::vector<std::string>{"ok"});
  }
  EXPECT_GT(killed, 0);
  EXPECT_GT(left_a_part, 0);  // else the test has proven nothing
  directory_.write("map.gmap", bytes);
  update();
  expectSameMap<3>(load(path), fresh);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

}  // namespace
}  // namespace gaussmap::test
