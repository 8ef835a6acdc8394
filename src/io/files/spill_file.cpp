// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/spill_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {

SpillFile::SpillFile(const std::filesystem::path& folder) : folder_(folder) {
  file_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file_ >= 0) return;
  std::string name = (folder / ".gaussmap-XXXXXX").string();  // for file systems without O_TMPFILE
  file_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) fail("no temporary file can be created in this folder", errno);
  ::unlink(name.c_str());
}

SpillFile::~SpillFile() {
  ::close(file_);
}

SpillFile::Span SpillFile::append(const std::string& bytes) {
  const Span span{end_, bytes.size()};
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = ::pwrite(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(end_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("a temporary file in this folder cannot be written", written < 0 ? errno : ENOSPC);
    done += static_cast<std::size_t>(written);
  }
  end_ += bytes.size();
  return span;
}

std::string SpillFile::read(const Span& span) const {
  std::string bytes(span.size, '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t got = ::pread(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(span.begin + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("a temporary file in this folder cannot be read", got < 0 ? errno : EIO);
    done += static_cast<std::size_t>(got);
  }
  return bytes;
}

void SpillFile::fail(const char* doing, int error) const {
  throw FileError(folder_, std::string(doing) + ": " + std::generic_category().message(error));
}

}  // namespace gaussmap::detail
