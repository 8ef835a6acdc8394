// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Attribute of a function: the compiler makes versions for several instruction sets, and the loader takes the best
/// one. The core is compiled without fused multiply-add, so that all versions round alike.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define GAUSSMAP_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define GAUSSMAP_CLONES
#endif
