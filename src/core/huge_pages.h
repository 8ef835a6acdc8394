// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gaussmap::detail {

/// Memory for an array that is touched at random, to be given back by std::free(): in huge pages where the system has
/// them, for a look-up then finds its page in the processor's table, and first touches cost a fraction.
/// Throws std::bad_alloc.
inline void* allocatePages(std::size_t bytes) {
  constexpr std::size_t kHuge = std::size_t{1} << 21;
  const bool is_large = bytes >= kHuge;
  void* const memory = is_large ? std::aligned_alloc(kHuge, (bytes + kHuge - 1) / kHuge * kHuge)
                                : std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
  if (is_large) madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: without it small pages do
#endif
  return memory;
}

/// Of vectors in such memory, whose elements are left as they are by resize().
template <typename T>
struct PagesAllocator {
  using value_type = T;

  PagesAllocator() = default;
  template <typename U>
  PagesAllocator(const PagesAllocator<U>&) {}

  T* allocate(std::size_t count) { return static_cast<T*>(allocatePages(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  friend bool operator==(const PagesAllocator&, const PagesAllocator&) { return true; }
  friend bool operator!=(const PagesAllocator&, const PagesAllocator&) { return false; }
};

}  // namespace gaussmap::detail
