// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// Shows the progress in one line on stderr, which each call overwrites. Prints nothing unless stderr is a terminal.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  void show(const AccumulateProgress& progress);

 private:
  bool on_terminal_;
  bool shown_ = false;
  double start_;
};

}  // namespace gaussmap::app
