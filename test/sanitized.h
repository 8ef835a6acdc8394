// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gaussmap::test {

/// True if built with a sanitizer: everything then takes several times longer and needs terabytes of address space.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace gaussmap::test
