// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::detail {

/// While an object exists, up to 64 MiB of the points of opened scans are kept until these scans are opened again, see
/// FileScans::keepForNextOpen(). Used to look at some scans before a command reads all of them.
class KeepingPoints {
 public:
  explicit KeepingPoints(FileScans& scans) : scans_(scans) { scans_.keepForNextOpen(std::size_t{64} << 20); }
  ~KeepingPoints() { scans_.keepForNextOpen(0); }
  KeepingPoints(const KeepingPoints&) = delete;
  KeepingPoints& operator=(const KeepingPoints&) = delete;

 private:
  FileScans& scans_;
};

}  // namespace gaussmap::detail
