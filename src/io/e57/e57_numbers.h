// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "io/e57/e57_description.h"

namespace gaussmap::detail {

/// Decodes the numbers `first` to `first` + `count` - 1 of a field. `bytes` are those of an E57Stream.
///
/// Returns the number of decoded values. It is less than `count` if the next value is greater than the maximum of an
/// integer field.
std::size_t decodeE57(const E57Field& field, const char* bytes, std::size_t first, std::size_t count, double* values);

}  // namespace gaussmap::detail
