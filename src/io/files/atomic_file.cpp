// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include "io/files/open_files.h"

namespace gaussmap::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAtOnce = std::size_t{1} << 30;  // write() accepts at most 2 GB per call

fs::path resolved(const fs::path& target) {
  std::error_code error;
  if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
  fs::path real = fs::weakly_canonical(target, error);
  if (error || fs::is_symlink(fs::symlink_status(real, error))) throw FileError(target, "is a broken symbolic link");
  return real;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(resolved(target)), part_(target_) {
  part_ += ".part";
  if (!target_.has_filename()) throw FileError(target, "names a folder, not a file");
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) throw FileError(target, "exists and is not a file");
  while (!openLocked()) {
  }
  // The destructor does not run if the constructor throws, so the file is closed here.
  if (::ftruncate(file_, 0) != 0) {
    const int reason = errno;
    closeFile();
    fail("cannot be emptied", reason);
  }
}

/// Returns false if another writer renamed or removed the part file between the opening and the locking. The part file
/// must then be opened again: the locked file is the finished target of the other writer, or has no name.
bool AtomicFile::openLocked() {
  file_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file_ < 0) fail("cannot be opened for writing", errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    closeFile();
    if (reason == EWOULDBLOCK) throw FileError(target_, "is being written by another process (" + part_.string() + ")");
    fail("cannot be locked", reason);
  }
  if (hasName(file_, part_.c_str())) {
    entry_ = open_parts.add(part_, file_);
    return true;
  }
  closeFile();
  return false;
}

AtomicFile::~AtomicFile() {
  if (file_ < 0) return;
  if (hasName(file_, part_.c_str())) ::unlink(part_.c_str());  // still locked, so it is not the file of another writer
  closeFile();
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (file_ < 0) throw FileError(target_, "is complete: nothing more can be written");
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = ::write(file_, next, std::min(bytes, kMaxAtOnce));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written", errno);
    }
    next += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void AtomicFile::commit() {
  if (file_ < 0) throw FileError(target_, "is complete already");
  if (!hasName(file_, part_.c_str()))
    throw FileError(part_, "was removed or replaced by another process while it was written");
  if (::fsync(file_) != 0) fail("cannot be synced to the disk", errno);
  if (std::rename(part_.c_str(), target_.c_str()) != 0) fail("cannot be renamed to its final name", errno);
  closeFile();

  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  const int directory = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;  // a folder can be writable but not readable; the system syncs it later
  const int reason = ::fsync(directory) == 0 ? 0 : errno;
  ::close(directory);
  // Some file systems cannot sync a folder and return EINVAL. Nothing more can be done then.
  if (reason != 0 && reason != EINVAL)
    throw FileError(target_, "is complete, but its folder cannot be synced to the disk: " +
                                 std::generic_category().message(reason));
}

void AtomicFile::closeFile() noexcept {
  if (entry_) OpenFiles::remove(entry_);
  entry_ = nullptr;
  ::close(file_);
  file_ = -1;
}

void AtomicFile::fail(const char* doing, int error) const {
  throw FileError(part_, std::string(doing) + ": " + std::generic_category().message(error));
}

}  // namespace gaussmap::detail
