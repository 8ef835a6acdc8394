// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#ifdef GAUSSMAP_PLAIN_THREADS
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace gaussmap::detail {

/// Returns the number of threads to use; 0 = all cores. It is limited to the number of cores, because TBB prints a
/// warning on stderr otherwise.
inline int threadCount(int threads) {
  const int most = tbb::info::default_concurrency();
  return threads <= 0 || threads > most ? most : threads;
}

#ifdef GAUSSMAP_PLAIN_THREADS
// For the thread sanitizer, which understands the synchronisation of these threads. TBB is not built with the
// sanitizer, so each of its loops would be reported as a race.
template <typename Body>
void parallelFor(std::size_t count, int threads, std::size_t grain, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto work = [&] {
    try {
      for (std::size_t first = next.fetch_add(grain); first < count; first = next.fetch_add(grain))
        for (std::size_t i = first; i < std::min(first + grain, count); ++i) body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threadCount(threads); ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

template <typename Body>
void parallelForWithin(std::size_t count, int, const Body& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}
#else
/// Calls body(i) for every i in [0, count). `threads`: 0 = all cores. `grain` = indices per task. The calls must not
/// depend on each other, and each writes its result to slot i, so the result does not depend on the number of threads.
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

/// Works like parallelFor() inside a body of parallelFor(), on its threads. A thread that waits for the end of this
/// loop does not start another body of the outer loop.
template <typename Body>
void parallelForWithin(std::size_t count, int threads, const Body& body) {
  if (threads == 1)
    for (std::size_t i = 0; i < count; ++i) body(i);
  else
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, body); });
}
#endif

}  // namespace gaussmap::detail
