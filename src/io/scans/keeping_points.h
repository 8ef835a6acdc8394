// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/io/scans/pcd_scans.h"

namespace gaussmap::detail {

/// While it exists, the points of opened scans are kept for the next time that these scans are opened, up to 64 MiB,
/// see PcdScans::keepForNextOpen(). For a look at some scans before a command reads all of them.
class KeepingPoints {
 public:
  explicit KeepingPoints(PcdScans& scans) : scans_(scans) { scans_.keepForNextOpen(std::size_t{64} << 20); }
  ~KeepingPoints() { scans_.keepForNextOpen(0); }
  KeepingPoints(const KeepingPoints&) = delete;
  KeepingPoints& operator=(const KeepingPoints&) = delete;

 private:
  PcdScans& scans_;
};

}  // namespace gaussmap::detail
