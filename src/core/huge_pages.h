// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace gaussmap::detail {

/// Allocates memory for an array with random access. The caller frees it with std::free(). It uses huge pages if the
/// system has them: the processor then finds the page of an address in its table (TLB), and the first access to the
/// memory is much cheaper. Throws std::bad_alloc.
inline void* allocatePages(std::size_t bytes) {
  constexpr std::size_t kHuge = std::size_t{1} << 21;
  const bool is_large = bytes >= kHuge;
  void* const memory = is_large ? std::aligned_alloc(kHuge, (bytes + kHuge - 1) / kHuge * kHuge)
                                : std::aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
  if (is_large) madvise(memory, bytes, MADV_HUGEPAGE);  // only a hint: small pages also work
#endif
  return memory;
}

/// Allocator for vectors in such memory. resize() does not initialise the new elements.
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
