// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// The version of the library. CMake and the commands read it here.
#define GAUSSMAP_VERSION "0.1.0"
#define GAUSSMAP_VERSION_MAJOR 0
#define GAUSSMAP_VERSION_MINOR 1
#define GAUSSMAP_VERSION_PATCH 0

/// Marks what a shared library exports: the public headers, nothing else.
#define GAUSSMAP_API __attribute__((visibility("default")))
