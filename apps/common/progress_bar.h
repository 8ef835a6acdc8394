// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// A line on stderr that is written over; silent unless stderr is a terminal.
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
