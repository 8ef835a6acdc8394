// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The version of the library as text. CMake and the commands read the version from this file.
#define GAUSSMAP_VERSION "0.1.0"
/// The first number of the version.
#define GAUSSMAP_VERSION_MAJOR 0
/// The second number of the version.
#define GAUSSMAP_VERSION_MINOR 1
/// The third number of the version.
#define GAUSSMAP_VERSION_PATCH 0

/// Marks a name that a shared library exports. Only the names in the public headers have this mark.
#define GAUSSMAP_API __attribute__((visibility("default")))
