// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// An older C++ standard gives hundreds of errors in the headers. #error does not stop the compiler before them, but a
// missing file does.
#if __cplusplus < 201703L
#include "gaussmap needs C++17: compile with -std=c++17 or later"
#endif

// With the flag -mavx or -march=native, Eigen aligns its types more strictly. The classes of PCL then have one layout
// in the program and another in the library, and the program crashes. The CMake target gaussmap::pcl defines
// GAUSSMAP_PCL_EIGEN_ALIGNMENT as the alignment of the library.
#ifdef GAUSSMAP_PCL_EIGEN_ALIGNMENT
#include <Eigen/Core>
#if EIGEN_MAX_ALIGN_BYTES != GAUSSMAP_PCL_EIGEN_ALIGNMENT
#define GAUSSMAP_TEXT_OF(value) #value
#define GAUSSMAP_VALUE_OF(value) GAUSSMAP_TEXT_OF(value)
static_assert(EIGEN_MAX_ALIGN_BYTES == GAUSSMAP_PCL_EIGEN_ALIGNMENT,
              "gaussmap::pcl was built with EIGEN_MAX_ALIGN_BYTES = " GAUSSMAP_VALUE_OF(GAUSSMAP_PCL_EIGEN_ALIGNMENT)
              ", but the flags of this program (-march=native, -mavx) change it. Compile with "
              "-DEIGEN_MAX_ALIGN_BYTES=" GAUSSMAP_VALUE_OF(GAUSSMAP_PCL_EIGEN_ALIGNMENT) ", or without these flags.");
#endif
#endif

/// The version of the library as text. CMake and the commands read the version from this file.
#define GAUSSMAP_VERSION "0.2.0"
/// The first number of the version.
#define GAUSSMAP_VERSION_MAJOR 0
/// The second number of the version.
#define GAUSSMAP_VERSION_MINOR 2
/// The third number of the version.
#define GAUSSMAP_VERSION_PATCH 0

/// Marks a name that a shared library exports: the names of the public headers, and the few internal ones that another
/// library or program of gaussmap uses.
#define GAUSSMAP_API __attribute__((visibility("default")))
