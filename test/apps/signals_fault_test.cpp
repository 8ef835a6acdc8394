// SPDX-License-Identifier: BSD-3-Clause
#include "common/signals.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "io/files/atomic_file.h"
#include "io/files/mapped_file.h"
#include "io/files/temporary_directory.h"
#include "sanitized.h"

namespace gaussmap::test {
using namespace detail;
using app::handleSignals;

namespace {

namespace fs = std::filesystem;

class Signals : public testing::Test {
 protected:
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_.path()), {}));
  }
  fs::path path(const std::string& name) const { return directory_.path() / name; }
  TemporaryDirectory directory_;
};

/// Status of a process that does this.
template <typename Action>
int statusOf(const Action& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    action();
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

TEST_F(Signals, RemoveEveryPartFileThatIsOpen) {
  directory_.write("old", "old");
  for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM, SIGXCPU}) {
    const int status = statusOf([&] {
      handleSignals("test");
      AtomicFile first(path("old")), second(path("new")), done(path("done"));
      first.write("half", 4);
      done.commit();
      ::raise(signal);
    });
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
    EXPECT_EQ(files(), 2u) << "old and done";
    std::string text;
    std::ifstream(path("old")) >> text;
    EXPECT_EQ(text, "old");
  }
}

TEST_F(Signals, OfAChildLeaveThePartFilesOfItsParent) {
  const AtomicFile file(path("target"));
  const int status = statusOf([] {
    handleSignals("test");
    ::raise(SIGTERM);
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::exists(file.partPath()));
}

TEST_F(Signals, LeaveAPartFileThatIsSomebodyElsesByNow) {
  const int status = statusOf([&] {
    handleSignals("test");
    const AtomicFile file(path("target"));
    directory_.write("target.part", "of another");  // in the place of the first
    ::raise(SIGTERM);
  });
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::exists(path("target.part")));
}

TEST_F(Signals, OfMemoryThatIsNotOursDoWhatTheyDid) {
  directory_.write("file", std::string(10000, 'x'));
  const int status = statusOf([&] {
    handleSignals("test");
    const MappedFile ours(path("file"));
    const int file = ::open(path("file").c_str(), O_RDWR);
    const auto* const theirs = static_cast<const char*>(::mmap(nullptr, 10000, PROT_READ, MAP_SHARED, file, 0));
    if (::ftruncate(file, 0) != 0) ::_exit(3);
    ::_exit(*static_cast<const volatile char*>(theirs));
  });
  if (kSanitized) {  // reports the fault and exits
    EXPECT_NE(status, 0);
  } else {
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), SIGBUS);
  }
}

TEST_F(Signals, NameTheMappedFileThatWasCutOff) {
  directory_.write("file", std::string(10000, 'x'));
  EXPECT_EXIT(
      {
        handleSignals("test");
        const AtomicFile output(path("output"));
        const MappedFile file(path("file"));
        fs::resize_file(path("file"), 0);
        const volatile char* const first = file.bytes().data();
        ::_exit(*first);
      },
      testing::ExitedWithCode(1), "test: .*/file: was cut off, or became unreadable, while it was read");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Signals, AreNotNeededToTellThatAFileIsShorter) {
  directory_.write("file", std::string(10000, 'x'));
  const MappedFile file(path("file"));
  EXPECT_NO_THROW(file.requireWhole());
  fs::resize_file(path("file"), 9000);
  EXPECT_EQ(file.bytes()[8999], 'x');
  EXPECT_EQ(file.bytes()[9000], '\0');  // the rest of the page: no signal tells of it
  EXPECT_THROW(file.requireWhole(), FileError);
  directory_.write("file", "another one of this name");
  EXPECT_NO_THROW(file.requireWhole());
}

TEST_F(Signals, ComeWithOneLineForAnExceptionThatNobodyCanCatch) {
  EXPECT_EXIT(
      {
        handleSignals("test");
        const AtomicFile output(path("output"));
        std::thread([] { throw std::runtime_error("no memory for a thread"); }).join();
      },
      testing::ExitedWithCode(1), "^test: no memory for a thread\n$");
  EXPECT_EQ(files(), 0u);
}

}  // namespace
}  // namespace gaussmap::test
