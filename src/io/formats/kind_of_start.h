// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace gaussmap::detail {

/// Returns the kind of a file that starts with these bytes, for messages: "a PNG picture". Returns an empty text if the
/// bytes are not the signature of a common kind.
std::string kindOfStart(std::string_view start);

/// Returns true if the first 4096 bytes are printable ASCII characters, tabs and line ends.
bool looksLikeText(std::string_view start);

}  // namespace gaussmap::detail
