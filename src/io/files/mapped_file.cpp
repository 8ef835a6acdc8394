// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "gaussmap/core/error.h"
#include "io/files/open_files.h"

namespace gaussmap::detail {
namespace {

[[noreturn]] void throwSystemError(const std::filesystem::path& path, const std::string& what) {
  throw FileError(path, what + ": " + std::generic_category().message(errno));
}

void requireRegular(const std::filesystem::path& path, const struct stat& status) {
  if (S_ISDIR(status.st_mode)) throw FileError(path, "is a directory, not a file");
  if (!S_ISREG(status.st_mode)) throw FileError(path, "is a pipe or a device: save it as a file first");
}

class Descriptor {
 public:
  // Non-blocking, because the file can have become a pipe since the check.
  explicit Descriptor(const std::filesystem::path& path)
      : number_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (number_ < 0) throwSystemError(path, "cannot be opened");
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) : path_(path) {
  // The file is checked before it is opened: opening alone can wake the other end of a pipe or start a device.
  struct stat status;
  if (stat(path.c_str(), &status) != 0) throwSystemError(path, "cannot be opened");
  requireRegular(path, status);
  const Descriptor descriptor(path);
  if (fstat(descriptor.number(), &status) != 0) throwSystemError(path, "cannot be read");
  requireRegular(path, status);
  device_ = status.st_dev;
  inode_ = status.st_ino;
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return;
  void* const address = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor.number(), 0);
  if (address == MAP_FAILED) throwSystemError(path, "cannot be read");
  bytes_ = {static_cast<const char*>(address), size};
  entry_ = mapped_files.add(path, -1, bytes_);
}

MappedFile::~MappedFile() {
  if (bytes_.empty()) return;
  OpenFiles::remove(entry_);
  munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

void MappedFile::requireWhole() const {
  // The check uses the name and not an open descriptor, because thousands of files can be mapped. A new file with this
  // name is no problem: the mapped file is still complete.
  struct stat status;
  if (stat(path_.c_str(), &status) != 0 || status.st_dev != device_ || status.st_ino != inode_) return;
  if (static_cast<std::size_t>(status.st_size) < bytes_.size())
    throw FileError(path_, "was cut off from " + std::to_string(bytes_.size()) + " to " +
                               std::to_string(status.st_size) + " bytes while it was read");
}

void MappedFile::release(std::string_view part) const {
  if (part.empty()) return;
  static const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto before = static_cast<std::size_t>(part.data() - bytes_.data()) % page;  // the map begins at a page
  // Only a hint, so a failure does not matter.
  madvise(const_cast<char*>(part.data() - before), part.size() + before, MADV_DONTNEED);
}

}  // namespace gaussmap::detail
