// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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
