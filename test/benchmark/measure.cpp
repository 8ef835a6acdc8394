// SPDX-License-Identifier: BSD-3-Clause
#include "measure.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>
#include <stdexcept>

#include "clock.h"

namespace gaussmap::benchmark {
namespace {

/// Returns a value of /proc/self/status [MB], or 0 if the line is missing.
double statusMegabytes(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (double kilobytes = 0.0; word == name + ":" && status >> kilobytes) return kilobytes / 1024.0;
  return 0.0;
}

[[noreturn]] void child(const std::function<double()>& work, Start how, int out) {
  Measured measured;
  try {
    std::ofstream("/proc/self/clear_refs") << 5;  // resets the peak
    const double before = statusMegabytes("VmRSS");
    double start = wallSeconds();
    measured.value = work();
    measured.seconds = wallSeconds() - start;
    measured.megabytes = std::max(0.0, statusMegabytes("VmHWM") - before);
    if (how == Start::Warm) {
      start = wallSeconds();
      work();
      measured.seconds = wallSeconds() - start;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gaussmap_benchmark: %s\n", error.what());
    _exit(1);
  }
  const bool written = write(out, &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
  _exit(written ? 0 : 1);
}

Measured inChild(const std::function<double()>& work, Start how) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe to a child process");
  malloc_trim(0);  // otherwise the child inherits memory that was freed but kept
  std::fflush(nullptr);
  const pid_t id = fork();
  if (id == 0) child(work, how, ends[1]);
  close(ends[1]);
  Measured measured;
  const bool read_all = id > 0 && read(ends[0], &measured, sizeof measured) == static_cast<ssize_t>(sizeof measured);
  close(ends[0]);
  int status = 1;
  if (id > 0) waitpid(id, &status, 0);
  if (!read_all || status != 0) throw std::runtime_error("a measured process failed");
  return measured;
}

Measured ofCommand(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const double start = wallSeconds();
  const pid_t id = fork();
  if (id == 0) {
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    execvp(arguments.front(), arguments.data());
    _exit(127);
  }
  int status = 1;
  rusage used{};
  if (id > 0) wait4(id, &status, 0, &used);
  if (status != 0) {
    std::ostringstream text;
    for (const std::string& word : words) text << word << ' ';
    throw std::runtime_error(text.str() + (status == 127 << 8 ? "is not installed" : "failed"));
  }
  return {wallSeconds() - start, static_cast<double>(used.ru_maxrss) / 1024.0, 0.0};
}

template <typename Work, typename Run>
std::vector<Measured> inTurn(const std::vector<Work>& works, int runs, const Run& run) {
  std::vector<std::vector<Measured>> all(works.size());
  std::vector<std::size_t> order(works.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(1);
  for (int i = 0; i < runs; ++i) {
    // In a fixed order, one work would always run after the peer that has just freed the most memory, and be slower.
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t w : order) all[w].push_back(run(works[w]));
  }
  // Other programs on the machine can only make a run longer, so the fastest run counts.
  std::vector<Measured> fastest;
  for (const std::vector<Measured>& of : all) {
    fastest.push_back(*std::min_element(of.begin(), of.end(),
                                        [](const Measured& a, const Measured& b) { return a.seconds < b.seconds; }));
    for (const Measured& one : of) fastest.back().megabytes = std::max(fastest.back().megabytes, one.megabytes);
  }
  return fastest;
}

}  // namespace

std::vector<Measured> measureInTurn(const std::vector<std::function<double()>>& works, int runs, Start start) {
  return inTurn(works, runs, [&](const std::function<double()>& work) { return inChild(work, start); });
}

std::vector<Measured> measureCommandsInTurn(const std::vector<std::vector<std::string>>& commands, int runs) {
  return inTurn(commands, runs, ofCommand);
}

}  // namespace gaussmap::benchmark
