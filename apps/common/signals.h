// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::app {

/// Installs signal handlers, so that a process that ends early leaves no half-written file and prints at most one line.
/// Programs call it once, at the start of main(). The library never calls it. `program` must live as long as the
/// process. Afterwards:
/// - SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM and SIGXCPU first remove the part files of every open AtomicFile, then
///   end the process as usual. A signal that is ignored at the call stays ignored.
/// - If another process truncates a file while it is being read (SIGBUS in mapped memory), the part files are removed,
///   `PROGRAM: FILE: was cut off ...` is printed on stderr, and the exit code is 1.
/// - An exception that no code can catch does the same with its message. An example is the exception of a thread that
///   cannot start another thread because no memory is left.
/// - A write beyond the limit on the size of files (SIGXFSZ) fails with FileError, like a write to a full disk.
void handleSignals(const char* program);

}  // namespace gaussmap::app
