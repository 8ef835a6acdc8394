// SPDX-License-Identifier: BSD-3-Clause
#include "common/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "common/report.h"

namespace gaussmap::app {

ProgressBar::ProgressBar() : on_terminal_(isatty(STDERR_FILENO) != 0), start_(now()) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(const AccumulateProgress& progress) {
  if (!on_terminal_) return;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * progress.scans_done / std::max<std::size_t>(progress.scans, 1));
  const double rate = static_cast<double>(progress.points) / std::max(now() - start_, 1e-3);
  std::fprintf(stderr, "\r\033[K[%s%s] %zu/%zu scans, %.1f M points/s, %zu cells",
               std::string(std::size_t(filled), '#').c_str(), std::string(std::size_t(kWidth - filled), '.').c_str(),
               progress.scans_done, progress.scans, rate / 1e6, progress.cells);
  std::fflush(stderr);
  shown_ = true;
}

}  // namespace gaussmap::app
