// SPDX-License-Identifier: BSD-3-Clause
#include "common/signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

#include "io/files/open_files.h"

// Handlers call only functions that POSIX lists as async-signal-safe.
namespace gaussmap::app {
using namespace detail;
namespace {

const char* program_name = "";
struct sigaction bus_error_before;

void removeParts() {
  const pid_t self = ::getpid();
  open_parts.forEach([&](const OpenFile& part) {
    if (part.process == self && hasName(part.file, part.path)) ::unlink(part.path);
  });
}

void endAsWithoutHandler(int signal) {
  removeParts();
  ::raise(signal);  // SA_RESETHAND has restored the default handler, which runs when this one returns
}

void print(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // stderr is closed, so there is nothing left to do
}

void endIfAFileWasCutOff(int, siginfo_t* info, void*) {
  const char* const address = static_cast<const char*>(info->si_addr);
  mapped_files.forEach([&](const OpenFile& file) {
    if (address < file.begin || address >= file.begin + file.bytes) return;
    removeParts();
    for (const char* const text :
         {program_name, ": ", file.path, ": was cut off, or became unreadable, while it was read\n"})
      print(text);
    ::_exit(1);
  });
  ::sigaction(SIGBUS, &bus_error_before, nullptr);  // another fault: repeats for the previous handler
}

[[noreturn]] void endAfterException() {
  removeParts();
  const auto end = [](const char* what) {
    for (const char* const text : {program_name, ": ", what, "\n"}) print(text);
    ::_exit(1);
  };
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    end("out of memory");
  } catch (const std::exception& error) {
    end(error.what());
  } catch (...) {
  }
  std::abort();
}

}  // namespace

void handleSignals(const char* program) {
  program_name = program;
  std::signal(SIGXFSZ, SIG_IGN);
  struct sigaction action {};
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  action.sa_handler = endAsWithoutHandler;
  for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM, SIGXCPU}) {
    struct sigaction before;
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_DFL)
      ::sigaction(signal, &action, nullptr);
  }
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = endIfAFileWasCutOff;
  ::sigaction(SIGBUS, &action, &bus_error_before);
  std::set_terminate(endAfterException);
}

}  // namespace gaussmap::app
