// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

namespace gaussmap {
using namespace detail;

namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gaussmap_atomic_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    target_ = folder_ / "map.gmap";
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void put(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
  static void write(AtomicFile& file, const std::string& text) { file.write(text.data(), text.size()); }
  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_, target_;
};

TEST_F(AtomicFileTest, AppearsWholeAtCommitAndLeavesNothingBeside) {
  {
    AtomicFile file(target_);
    EXPECT_EQ(file.partPath(), fs::path(target_.string() + ".part"));
    write(file, "one ");
    write(file, "two");
    EXPECT_FALSE(fs::exists(target_));
    file.commit();
    EXPECT_EQ(contents(target_), "one two");
  }
  EXPECT_EQ(contents(target_), "one two");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, WithoutCommitLeavesTheOldFileAlone) {
  put(target_, "old");
  {
    AtomicFile file(target_);
    write(file, "new");
    EXPECT_EQ(contents(target_), "old");
  }
  EXPECT_EQ(contents(target_), "old");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, ReplacesTheOldFileForNewReadersOnly) {
  put(target_, "old");
  std::ifstream reader(target_);
  AtomicFile file(target_);
  write(file, "new");
  file.commit();
  EXPECT_EQ(contents(target_), "new");
  std::string text;
  reader >> text;
  EXPECT_EQ(text, "old");
}

TEST_F(AtomicFileTest, TellsASecondWriterAndDoesNotDisturbTheFirst) {
  AtomicFile first(target_);
  write(first, "first");
  try {
    AtomicFile second(target_);
    FAIL() << "two writers";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("being written by another process"), std::string::npos) << error.what();
  }
  first.commit();
  EXPECT_EQ(contents(target_), "first");
  AtomicFile third(target_);  // and afterwards the way is free
  write(third, "third");
  third.commit();
  EXPECT_EQ(contents(target_), "third");
}

TEST_F(AtomicFileTest, TellsASecondWriterInAnotherProcess) {
  AtomicFile first(target_);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    try {
      AtomicFile second(target_);
    } catch (const FileError&) {
      ::_exit(42);
    }
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_TRUE(fs::exists(first.partPath()));
}

TEST_F(AtomicFileTest, TakesOverWhatAKilledWriterLeft) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    AtomicFile file(target_);
    write(file, "a long half of a map");
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(contents(target_.string() + ".part"), "a long half of a map");
  AtomicFile file(target_);
  write(file, "short");
  file.commit();
  EXPECT_EQ(contents(target_), "short");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, KeepsTheTargetWholeWhileManyWritersRace) {
  std::vector<pid_t> children;
  for (char letter = 'a'; letter < 'e'; ++letter) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (int round = 0; round < 50; ++round) {
        try {
          AtomicFile file(target_);
          for (int piece = 0; piece < 10; ++piece) write(file, std::string(1000, letter));
          file.commit();
        } catch (const FileError&) {  // somebody else's turn
        }
      }
      ::_exit(0);
    }
    children.push_back(child);
  }
  std::size_t looks = 0;
  for (std::size_t done = 0; done < children.size();) {
    if (::waitpid(-1, nullptr, WNOHANG) > 0) ++done;
    if (!fs::exists(target_)) continue;
    const std::string text = contents(target_);
    ASSERT_EQ(text, std::string(10000, text.empty() ? '?' : text[0])) << "look " << looks;
    ++looks;
  }
  EXPECT_GT(looks, 0u);
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, LetsAnotherLibraryFillThePartFile) {
  AtomicFile file(target_);
  put(file.partPath(), "by somebody else");
  file.commit();
  EXPECT_EQ(contents(target_), "by somebody else");
}

TEST_F(AtomicFileTest, RefusesToCommitAFileThatWasReplaced) {
  put(target_, "old");
  {
    AtomicFile file(target_);
    put(folder_ / "other", "not ours");
    fs::rename(folder_ / "other", file.partPath());
    EXPECT_THROW(file.commit(), FileError);
  }
  EXPECT_EQ(contents(target_), "old");
  EXPECT_EQ(contents(target_.string() + ".part"), "not ours");  // and does not remove what is not its own
}

TEST_F(AtomicFileTest, SaysThatTheDiskIsFullAndRemovesThePart) {  // a limit on the size of files stands in for it
  put(target_, "old");
  struct rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit limit = before;
  limit.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::string message;
  try {
    AtomicFile file(target_);
    write(file, std::string(10000, 'x'));
    file.commit();
  } catch (const FileError& error) {
    message = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("cannot be written"), std::string::npos) << message;
  EXPECT_EQ(contents(target_), "old");
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, TakesNothingAfterCommit) {
  AtomicFile file(target_);
  file.commit();
  EXPECT_EQ(contents(target_), "");
  EXPECT_THROW(write(file, "late"), FileError);
  EXPECT_THROW(file.commit(), FileError);
}

TEST_F(AtomicFileTest, FollowsALinkAndKeepsIt) {
  put(folder_ / "real", "old");
  fs::create_symlink("real", target_);
  AtomicFile file(target_);
  write(file, "new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(target_));
  EXPECT_EQ(contents(folder_ / "real"), "new");
}

TEST_F(AtomicFileTest, RefusesTargetsThatAreNoFiles) {
  EXPECT_THROW(AtomicFile{folder_}, FileError);
  EXPECT_THROW(AtomicFile{folder_ / ""}, FileError);
  EXPECT_THROW(AtomicFile{fs::path()}, FileError);
  EXPECT_THROW(AtomicFile{"/dev/null"}, FileError);
  EXPECT_THROW(AtomicFile{folder_ / "missing" / "file"}, FileError);
  fs::create_symlink("nowhere", target_);
  EXPECT_THROW(AtomicFile{target_}, FileError);
  EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(AtomicFileTest, WorksInTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  {
    AtomicFile file("plain");
    write(file, "here");
    file.commit();
  }
  fs::current_path(before);
  EXPECT_EQ(contents(folder_ / "plain"), "here");
}

}  // namespace
}  // namespace gaussmap
