// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "gaussmap/core/error.h"
#include "gaussmap/core/scans.h"

namespace gaussmap::test {

/// One scan that cannot be read. It shows which checks happen before anything is read.
class UnreadableScans : public Scans {
 public:
  std::size_t size() const override { return 1; }
  ScanInfo info(std::size_t) const override { return {"unreadable", {}, std::nullopt}; }
  std::unique_ptr<ScanReader> open(std::size_t) const override { throw FileError("unreadable", "was read"); }
};

}  // namespace gaussmap::test
