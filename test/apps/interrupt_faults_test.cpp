// SPDX-License-Identifier: BSD-3-Clause
// What comes from outside while the program is at work: signals, a second writer, a file that is cut off.
#include <fstream>

#include "apps/app_fixture.h"
#include "apps/traced_app.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A write into a part file begins.
bool writesPart(const TracedApp::Call& call) {
  return call.begins && (call.number == SYS_write || call.number == SYS_pwrite64) && endsWith(call.file, ".part");
}
/// A part file is complete and about to be brought to the disk.
bool finishesPart(const TracedApp::Call& call) {
  return call.begins && call.number == SYS_fsync && endsWith(call.file, ".part");
}
auto opened(const std::string& name) {
  return [name](const TracedApp::Call& call) {
    return !call.begins && call.number == SYS_openat && endsWith(call.file, name);
  };
}
auto mapped(const std::string& name) {
  return [name](const TracedApp::Call& call) {
    return !call.begins && call.number == SYS_mmap && endsWith(call.file, name);
  };
}

class Interrupted : public Apps {
 protected:
  void SetUp() override {
    TracedApp probe({"--version"});
    if (!probe.isTraced()) GTEST_SKIP() << "no right to trace a process";
    fs::copy_file(scene("map.gmap"), own("old.gmap"));
  }

  /// Whatever writes `old.gmap`.
  std::vector<std::vector<std::string>> writers() const {
    const std::string scans = scene("scans"), old = own("old.gmap");
    return {{"pcd2map", scans, "-o", old, "--force", "--threads", "1", "--no-curves"},
            {"pcd2map", scans, "-o", old, "--force", "--threads", "1", "--max-memory", "20M"},
            {"pcd2map", scans, "--update", old, "--threads", "1"},
            {"refine", scene("map.gmap"), "-o", old, "--force", "--budget", "2", "--threads", "1"}};
  }

  /// Ends the program at such a place; false if it never came there.
  template <typename Place>
  bool endAt(const std::vector<std::string>& writer, const Place& place, int n, int signal) const {
    SCOPED_TRACE(testing::PrintToString(writer) + " at " + std::to_string(n) + " by " + std::to_string(signal));
    const std::string before = contentsOf(own("old.gmap"));
    TracedApp app(writer);
    const bool came = app.runTo(place, n);
    if (!came) return false;
    const Outcome outcome = app.outcome(signal);
    EXPECT_EQ(outcome.signal, signal) << outcome.code;
    EXPECT_EQ(outcome.out + outcome.err, "");
    EXPECT_EQ(contentsOf(own("old.gmap")), before);
    EXPECT_EQ(ownFiles(), std::vector<std::string>{"old.gmap"});
    return true;
  }
};

TEST_F(Interrupted, WhileScansAreReadLeaveTheOldMapOnly) {
  const auto third = opened("scan02.pcd");
  int signal = SIGINT;
  for (const std::vector<std::string>& writer : writers()) {
    if (writer.front() != "pcd2map") continue;
    EXPECT_TRUE(endAt(writer, third, 1, signal));
    signal = SIGTERM;
  }
}

TEST_F(Interrupted, WhileTheMapIsWrittenLeaveTheOldMapOnly) {
  for (const std::vector<std::string>& writer : writers())
    for (const int signal : {SIGINT, SIGTERM}) {
      EXPECT_TRUE(endAt(writer, writesPart, 1, signal));
      EXPECT_TRUE(endAt(writer, writesPart, 7, signal));
      EXPECT_TRUE(endAt(writer, finishesPart, 1, signal));
    }
  for (const int signal : {SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU})
    EXPECT_TRUE(endAt(writers().front(), writesPart, 2, signal));
}

TEST_F(Interrupted, BySignalsThatTheShellIgnoresGoOn) {  // nohup
  const auto ignored = std::signal(SIGHUP, SIG_IGN);
  TracedApp app({"refine", scene("map.gmap"), "-o", own("new.gmap"), "--threads", "1"});
  std::signal(SIGHUP, ignored);
  ASSERT_TRUE(app.runTo(writesPart));
  EXPECT_EQ(app.outcome(SIGHUP).code, 0);
  EXPECT_EQ(load(own("new.gmap")).cellCount(0), load(scene("map.gmap")).cellCount(0));
}

TEST_F(Interrupted, ByASecondWriterFinishWhileThatOneIsTold) {
  for (const std::vector<std::string>& writer : writers()) {
    SCOPED_TRACE(testing::PrintToString(writer));
    TracedApp first(writer);
    ASSERT_TRUE(first.runTo(writesPart, 2));
    const std::string bytes = contentsOf(own("old.gmap"));
    for (const std::vector<std::string>& second : writers())
      expectDataError("is being written by another process", second);
    EXPECT_EQ(contentsOf(own("old.gmap")), bytes);
    EXPECT_EQ(first.outcome().code, 0);
    EXPECT_FALSE(fs::exists(own("old.gmap.part")));
    load(own("old.gmap"));
  }
}

/// Files that are cut off when the program has them open.
class CutOff : public Interrupted {
 protected:
  /// Cuts to `bytes` once the program has mapped it for the n-th time.
  void expectTold(const std::vector<std::string>& command, const std::string& name, std::uintmax_t bytes, int n = 1,
                  const std::string& why = "was cut off") const {
    SCOPED_TRACE(testing::PrintToString(command) + " cut to " + std::to_string(bytes));
    const std::vector<std::string> before = ownFiles();
    const std::string whole = contentsOf(own(name)), old = contentsOf(own("old.gmap"));
    TracedApp app(command);
    ASSERT_TRUE(app.runTo(mapped(name), n));
    fs::resize_file(own(name), bytes);
    const Outcome outcome = app.outcome();
    EXPECT_EQ(outcome.code, 1) << outcome.signal;
    EXPECT_EQ(outcome.err.find("gaussmap: " + own(name) + ": "), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(ownFiles(), before);
    EXPECT_EQ(contentsOf(own("old.gmap")), old);
    directory_.write(name, whole);
  }

  /// 30,000 points.
  static std::string cloud(const std::string& data) {
    std::string text =
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 30000\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 30000\nDATA " +
        data + "\n";
    for (int i = 0; i < 30000; ++i) {
      const float point[3] = {static_cast<float>(i % 100), static_cast<float>(i / 100), 1.5f};
      if (data == "ascii")
        text += std::to_string(i % 100) + " " + std::to_string(i / 100) + " 1.5\n";
      else
        text.append(reinterpret_cast<const char*>(point), sizeof point);
    }
    return text;
  }
};

TEST_F(CutOff, ScansAreNamed) {
  constexpr int kReading = 2;  // the file is mapped once before, to find out its kind
  for (const char* const data : {"binary", "ascii"}) {
    directory_.write("cut.pcd", cloud(data));
    const std::uintmax_t size = fs::file_size(own("cut.pcd"));
    // To nothing, to whole pages, within the last page (where zeros take the place of what is gone).
    for (const std::uintmax_t bytes : {std::uintmax_t{0}, std::uintmax_t{8 * 4096}, size - 1}) {
      const std::string scan = own("cut.pcd");
      // A text may be seen to be damaged before it is seen to be shorter.
      const std::string why = data == "ascii"s && bytes == size - 1 ? "" : "was cut off";
      for (const char* const frame : {"sensor", "map"})
        expectTold({"pcd2map", scan, "-o", own("x.gmap"), "--threads", "1", "--frame", frame}, "cut.pcd", bytes,
                   kReading, why);
      expectTold({"pcd2map", scan, "-o", own("x.gmap"), "--threads", "1", "--max-memory", "20M"}, "cut.pcd", bytes,
                 kReading, why);
      expectTold({"pcd2map", scan, "--update", own("old.gmap"), "--threads", "1"}, "cut.pcd", bytes, kReading, why);
    }
  }
  directory_.write("cut.pcd", cloud("binary"));
  fs::create_directory(own("still"));
  expectTold({"clean", own("cut.pcd"), scene("scans"), "-o", own("still"), "--threads", "1"}, "cut.pcd",
             fs::file_size(own("cut.pcd")) - 1, kReading);
}

TEST_F(CutOff, MeshesAndLogsAreNamed) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  directory_.write("cut.ply", ply);
  expectTold({"hausdorff", own("old.gmap"), own("cut.ply"), "--threads", "1"}, "cut.ply", 0);
  std::string poses;
  for (int i = 0; i < 2000; ++i) poses += "scan0" + std::to_string(i) + ".pcd 1 2 3 0 0 0 1\n";
  directory_.write("cut.txt", poses);
  expectTold({"pcd2map", scene("scans"), "-o", own("x.gmap"), "--poses", own("cut.txt"), "--threads", "1"}, "cut.txt",
             0);
}

TEST_F(CutOff, MapsAreNamed) {  // read by SQLite, which does not map files
  succeed({"pcd2map", scene("scans"), "-o", own("cut.gmap"), "--budget", "1"});
  for (const std::size_t bytes : {0u, 4096u, 20000u}) {
    const std::string whole = contentsOf(own("cut.gmap"));
    TracedApp app({"refine", own("cut.gmap"), "-o", own("x.gmap"), "--threads", "1"});
    ASSERT_TRUE(app.runTo(opened("cut.gmap"), 3));
    fs::resize_file(own("cut.gmap"), bytes);
    const Outcome outcome = app.outcome();
    EXPECT_EQ(outcome.code, 1) << outcome.signal;
    EXPECT_EQ(outcome.err.find("gaussmap: " + own("cut.gmap") + ": "), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(own("x.gmap")));
    directory_.write("cut.gmap", whole);
  }
}

}  // namespace
}  // namespace gaussmap::test
