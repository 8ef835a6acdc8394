// SPDX-License-Identifier: BSD-3-Clause
// The real program on a machine in trouble: full disks, forbidden places, no memory, no threads.
#include <grp.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <fstream>
#include <map>

#include "apps/app_fixture.h"
#include "sanitized.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

constexpr uid_t kNobody = 65534;

std::function<void()> withLimit(int resource, rlim_t most) {
  return [resource, most] {
    const struct rlimit limit { most, most };
    if (::setrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0) ::_exit(125);
  };
}

/// As a user for whom permissions count.
void asNobody() {
  if (::geteuid() != 0) return;
  if (::setgroups(0, nullptr) != 0 || ::setgid(kNobody) != 0 || ::setuid(kNobody) != 0) ::_exit(125);
}

class Faults : public Apps {
 protected:
  /// Every kind of output, written to its place among the test's own files.
  std::vector<std::vector<std::string>> writers() const {
    const std::string map = scene("map.gmap"), scans = scene("scans");
    return {{"pcd2map", scans, "-o", own("a.gmap"), "--force"},
            {"pcd2map", scans, "-o", own("a.gmap"), "--force", "--max-memory", "20M"},
            {"pcd2map", scans, "-o", own("a.gmap"), "--force", "--online"},
            {"pcd2map", scans, "--update", own("a.gmap")},
            {"refine", map, "-o", own("a.gmap"), "--force"},
            {"compress", map, "-o", own("a.gmap"), "--force", "--max-error", "0.5"},
            {"merge", map, map, "-o", own("a.gmap"), "--force"},
            {"export", map, own("a.pcd"), "--force"},
            {"clean", scans, "-o", own("still"), "--force"},
            {"draw", map, "-o", own("a.svg"), "--force"},
            {"tiles", map, "-o", own("tiles")},
            {"simulate", "-o", own("world"), "--rings", "8", "--columns", "60"},
            {"segments", own("plan/scans"), "-o", own("a.csv"), "--force"},
            {"segments", own("plan/scans"), "-o", own("a.geojson"), "--force"},
            {"segments", own("plan/scans"), "--stats", own("stats.csv"), "--force"}};
  }
  void makeInputs() const {
    fs::copy_file(scene("map.gmap"), own("a.gmap"));
    fs::create_directory(own("still"));
    fs::create_directories(own("world/scans"));
    succeed({"simulate", "plan", "-o", own("plan"), "--scans", "40", "--columns", "90"});
  }
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const std::string& name : ownFiles())
      if (fs::is_regular_file(own(name))) all[name] = contentsOf(own(name));
    return all;
  }
};

TEST_F(Faults, OnAFullDiskAreToldAndLeaveTheOldFiles) {  // a limit on the size of files stands in for it
  makeInputs();
  const auto before = contents();
  for (const std::vector<std::string>& writer : writers()) {
    const auto full = withLimit(RLIMIT_FSIZE, 600);
    expectDataError("cannot be written", writer, full);
    EXPECT_EQ(contents(), before) << writer.front();
  }
}

TEST_F(Faults, OnASmallDiskAreToldAndLeaveTheOldFiles) {
  const std::string disk = own("disk");
  fs::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=96k") != 0) GTEST_SKIP() << "no right to mount a file system";
  const std::string map = disk + "/map.gmap";
  for (const char* const memory : {"", "20M"}) {
    std::vector<std::string> command = {"pcd2map", scene("scans"), "-o", map, "--resolution", "0.05"};
    if (*memory) command.insert(command.end(), {"--max-memory", memory});
    expectDataError(*memory ? ": " : "cannot be written", command);
  }
  succeed({"pcd2map", scene("scans"), "-o", map, "--resolution", "1", "--ratio", "4"});
  const std::string bytes = contentsOf(map);
  std::ofstream(disk + "/rest") << std::string(100000, 'x') << std::flush;  // what fits
  expectDataError("cannot be written: No space left on device", {"pcd2map", scene("scans"), "--update", map});
  EXPECT_EQ(contentsOf(map), bytes);
  EXPECT_EQ(::umount(disk.c_str()), 0);
}

TEST_F(Faults, WithoutPermissionAreToldWhere) {
  const StartedApp probe({"--version"}, asNobody);
  if (probe.outcome().code != 0) GTEST_SKIP() << "another user may not start " GAUSSMAP_APP;
  fs::copy_file(scene("map.gmap"), own("map.gmap"));
  fs::copy_file(scene("scans") / "scan00.pcd", own("scan.pcd"));
  const std::string folder = directory_.path();
  fs::permissions(folder,
                  fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
  expectFailure(2, folder + " cannot be written to", {"pcd2map", scene("scans"), "-o", own("x.gmap")}, asNobody);
  expectFailure(2, folder + " cannot be written to", {"draw", own("map.gmap"), "-o", own("x.svg")}, asNobody);
  expectDataError("Permission denied", {"pcd2map", own("scan.pcd"), "--update", own("map.gmap")}, asNobody);
  fs::permissions(folder, fs::perms::all);
  for (const char* const name : {"map.gmap", "scan.pcd"}) fs::permissions(own(name), fs::perms::none);
  expectDataError(own("map.gmap") + ": cannot be opened for reading", {"info", own("map.gmap")}, asNobody);
  expectDataError(own("map.gmap") + ": ", {"pcd2map", scene("scans"), "--update", own("map.gmap")}, asNobody);
  expectDataError(own("scan.pcd") + ": cannot be opened: Permission denied",
                  {"pcd2map", own("scan.pcd"), "-o", own("x.gmap")}, asNobody);
  fs::create_directory(own("scans"));
  fs::permissions(own("scans"), fs::perms::none);
  expectDataError(own("scans") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")}, asNobody);
  for (const auto& entry : fs::directory_iterator(folder)) fs::permissions(entry.path(), fs::perms::owner_all);
}

TEST_F(Faults, WithoutMemoryAreToldAndLeaveTheOldFiles) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need terabytes of address space";
  makeInputs();
  const auto before = contents();
  succeed({"pcd2map", scene("scans"), "-o", own("fine.gmap"), "--resolution", "0.02"});
  const std::string made = contentsOf(own("fine.gmap"));
  int refused = 0, done = 0;
  for (rlim_t kilobytes = 16000; done < 2; kilobytes += kilobytes / 12) {  // from nothing to enough
    ASSERT_LT(kilobytes, 4000000u);
    fs::remove(own("fine.gmap"));
    SCOPED_TRACE(kilobytes);
    const std::vector<std::string> command = {"pcd2map",        scene("scans"), "-o",
                                              own("fine.gmap"), "--resolution", "0.02"};
    const Outcome outcome = runApp(command, "", withLimit(RLIMIT_AS, kilobytes * 1000));
    if (outcome.code == StartedApp::kNotStarted) continue;  // not even the program's libraries fit
    EXPECT_EQ(outcome.signal, 0) << outcome.err;
    if (outcome.code == 0) {
      ++done;
      EXPECT_EQ(contentsOf(own("fine.gmap")), made);
    } else {
      ++refused;
      EXPECT_EQ(outcome.code, 1);
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
      EXPECT_TRUE(outcome.err.find("out of memory: use ") != std::string::npos ||
                  outcome.err.find("try --threads 1") != std::string::npos ||
                  outcome.err.find("emory") != std::string::npos)
          << outcome.err;
      EXPECT_EQ(contents(), before);
    }
  }
  EXPECT_GT(refused, 2);
}

TEST_F(Faults, WithoutThreadsAreToldWhatToDo) {
  const StartedApp probe({"--version"}, asNobody);
  if (probe.outcome().code != 0) GTEST_SKIP() << "another user may not start " GAUSSMAP_APP;
  fs::permissions(directory_.path(), fs::perms::all);
  const auto no_threads = [] {
    asNobody();
    withLimit(RLIMIT_NPROC, 0)();
  };
  std::vector<std::string> command = {"pcd2map", scene("scans"), "-o", own("a.gmap")};
  if (runApp({"--version"}, "", no_threads).code != 0) GTEST_SKIP() << "the sanitizer needs a thread";
  const Outcome outcome = runApp(command, "", no_threads);
  if (outcome.code == 0) GTEST_SKIP() << "one processor: no thread is started";
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("try --threads 1"), std::string::npos) << outcome.err;
  EXPECT_EQ(ownFiles(), std::vector<std::string>{});
  command.insert(command.end(), {"--threads", "1"});
  EXPECT_EQ(runApp(command, "", no_threads).code, 0);
}

}  // namespace
}  // namespace gaussmap::test
