// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>

namespace gaussmap {

/// How many threads `threads` means: 0 = all; never more than there are, for TBB warns of that on stderr.
inline int threadCount(int threads) {
  const int most = tbb::info::default_concurrency();
  return threads <= 0 || threads > most ? most : threads;
}

/// Calls body(i) for every i in [0, count) on `threads` threads (0 = all). The bodies must not depend on each
/// other: results belong into slot i, so that the number of threads never shows in them. `grain` = indices a task.
template <typename Body>
void parallelFor(std::size_t count, int threads, std::size_t grain, const Body& body) {
  if (threads == 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  tbb::task_arena arena(threadCount(threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const tbb::blocked_range<std::size_t>& r) {
      for (std::size_t i = r.begin(); i != r.end(); ++i) body(i);
    });
  });
}

}  // namespace gaussmap
