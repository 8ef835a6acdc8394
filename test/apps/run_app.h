// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/file_contents.h"

extern char** environ;

namespace gaussmap::test {

/// What a program did.
struct Outcome {
  int code = -1;  ///< exit code, -1 if a signal ended it
  std::string out, err;
};

/// Runs gaussmap as a shell would; stdout and stderr go through files, so that no full pipe can stop it.
inline Outcome runApp(const std::vector<std::string>& arguments, const std::string& out_path = "") {
  std::string folder = (std::filesystem::temp_directory_path() / "gaussmap-run-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary directory");
  const std::string out = out_path.empty() ? folder + "/out" : out_path, err = folder + "/err";

  std::vector<std::string> words = {GAUSSMAP_APP};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, GAUSSMAP_APP, &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("cannot start " GAUSSMAP_APP);
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("lost " GAUSSMAP_APP);

  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, out_path.empty() ? contentsOf(out) : "",
                  contentsOf(err)};
  std::filesystem::remove_all(folder);
  return outcome;
}

}  // namespace gaussmap::test
