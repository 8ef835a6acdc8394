// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::app {

/// For programs, once, at the start of main(): what the system does to a process leaves no half-written file behind and
/// is told in one line. The library never does this by itself. Afterwards
/// - SIGHUP, SIGINT, SIGQUIT, SIGPIPE, SIGTERM and SIGXCPU remove the part files of every open AtomicFile, then end the
///   process as they would have; one that is ignored at the call stays ignored;
/// - a file that is cut off by somebody else while it is read (SIGBUS in mapped memory) removes them too, prints
///   `<program>: <file>: was cut off ...` on stderr and ends the process with exit code 1;
/// - an exception that nobody can catch (one of a thread that starts another when there is no memory left) does the
///   same with its message;
/// - a write beyond the limit on the size of files (SIGXFSZ) fails like one on a full disk: FileError.
/// `program` must live as long as the process.
void handleSignals(const char* program);

}  // namespace gaussmap::app
