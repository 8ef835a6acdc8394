// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/ptrace.h>
#include <sys/syscall.h>

#include <csignal>

#include "apps/run_app.h"

namespace gaussmap::test {

/// gaussmap under a tracer. It runs to a system call and is stopped there, so that a test can act at an exact place
/// instead of at a certain time. One thread only (--threads 1).
class TracedApp {
 public:
  /// A system call: its number and the file that it uses or opens.
  struct Call {
    std::uint64_t number = 0;
    std::string file;
    bool begins = false;  ///< false: the call has just ended
  };

  explicit TracedApp(const std::vector<std::string>& arguments)
      : app_(arguments, [] {
          if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(kNotTraced);
        }) {
    int status = 0;
    ::waitpid(app_.id(), &status, 0);
    held_ = WIFSTOPPED(status);  // at the start of the program
    if (held_) ::ptrace(PTRACE_SETOPTIONS, app_.id(), nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  }
  ~TracedApp() {
    if (held_) outcome(SIGKILL);
  }

  /// Returns false if the machine does not permit tracing. The other functions do not work then.
  bool isTraced() const { return held_; }
  pid_t id() const { return app_.id(); }

  /// Continues until the n-th matching call from here. Returns false if the program ends before.
  template <typename Matches>
  bool runTo(const Matches& matches, int n = 1) {
    int signal = 0;
    for (;;) {
      ::ptrace(PTRACE_SYSCALL, id(), nullptr, signal);
      int status = 0;
      ::waitpid(id(), &status, 0);
      held_ = WIFSTOPPED(status);
      if (!held_) return false;
      const bool at_call = WSTOPSIG(status) == (SIGTRAP | 0x80);
      signal = at_call ? 0 : WSTOPSIG(status);
      if (at_call && matches(call()) && --n == 0) return true;
    }
  }

  /// Sends a signal (0: none), lets the program continue without tracing, and waits for its end.
  Outcome outcome(int signal = 0) {
    if (signal != 0) ::kill(id(), signal);
    ::ptrace(PTRACE_DETACH, id(), nullptr, nullptr);
    held_ = false;
    return app_.outcome();
  }

 private:
  static constexpr int kNotTraced = 124;

  std::string fileOf(std::uint64_t descriptor) const {
    std::error_code error;
    const auto name = std::filesystem::read_symlink(
        "/proc/" + std::to_string(id()) + "/fd/" + std::to_string(static_cast<int>(descriptor)), error);
    return error ? "" : name.string();
  }

  Call call() {
    struct __ptrace_syscall_info info {};
    ::ptrace(PTRACE_GET_SYSCALL_INFO, id(), sizeof info, &info);
    if (info.op == PTRACE_SYSCALL_INFO_ENTRY) {
      last_ = {info.entry.nr, "", true};
      switch (info.entry.nr) {
        case SYS_write:
        case SYS_pwrite64:
        case SYS_fsync:
          last_.file = fileOf(info.entry.args[0]);
          break;
        case SYS_mmap:
          last_.file = fileOf(info.entry.args[4]);
          break;
        default:
          break;
      }
    } else {
      last_.begins = false;
      if (last_.number == SYS_openat) last_.file = fileOf(static_cast<std::uint64_t>(info.exit.rval));
    }
    return last_;
  }

  StartedApp app_;
  Call last_;
  bool held_ = false;
};

}  // namespace gaussmap::test
