// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/files/file_contents.h"

namespace gaussmap::test {

/// The result of a program.
struct Outcome {
  int code = -1;   ///< exit code, -1 if a signal ended it
  int signal = 0;  ///< the signal that ended it
  std::string out, err;
};

/// A running gaussmap. stdout and stderr go through files, so no full pipe can block it.
class StartedApp {
 public:
  /// `in_child` runs in the new process just before the program. stdout goes to `out_path` if it is not empty.
  explicit StartedApp(const std::vector<std::string>& arguments, const std::function<void()>& in_child = {},
                      const std::string& out_path = "")
      : folder_((std::filesystem::temp_directory_path() / "gaussmap-run-XXXXXX").string()) {
    if (::mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no temporary directory");
    const std::string out = out_path.empty() ? folder_ + "/out" : out_path, err = folder_ + "/err";
    std::vector<std::string> words = {GAUSSMAP_APP};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ < 0) throw std::runtime_error("cannot start " GAUSSMAP_APP);
    if (child_ > 0) return;
    const auto put = [](int file, int at) {
      if (file < 0 || ::dup2(file, at) < 0) ::_exit(126);
      ::close(file);
    };
    put(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    put(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    put(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    if (in_child) in_child();
    ::execv(GAUSSMAP_APP, argv.data());
    ::_exit(kNotStarted);
  }
  ~StartedApp() { std::filesystem::remove_all(folder_); }
  StartedApp(const StartedApp&) = delete;
  StartedApp& operator=(const StartedApp&) = delete;

  static constexpr int kNotStarted = 127;
  pid_t id() const { return child_; }

  /// Waits for the end of the program.
  Outcome outcome() const {
    int status = 0;
    if (::waitpid(child_, &status, 0) != child_) throw std::runtime_error("lost " GAUSSMAP_APP);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
            std::filesystem::exists(folder_ + "/out") ? contentsOf(folder_ + "/out") : "",
            contentsOf(folder_ + "/err")};
  }

 private:
  std::string folder_;
  pid_t child_ = 0;
};

/// Runs gaussmap like a shell.
inline Outcome runApp(const std::vector<std::string>& arguments, const std::string& out_path = "",
                      const std::function<void()>& in_child = {}) {
  return StartedApp(arguments, in_child, out_path).outcome();
}

}  // namespace gaussmap::test
