// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "fuzz_file.h"
#include "io/formats/message_file.h"

namespace gaussmap::fuzz {

/// Opens a recording and reads its first messages.
inline void readRecording(const std::filesystem::path& path) {
  refusesOrReads([&] {
    const auto file = detail::openMessageFile(path);
    file->warnings();
    const auto& messages = file->messages();
    for (std::size_t i = 0; i < std::min<std::size_t>(messages.size(), 50); ++i) {
      if (messages[i].topic >= file->topics().size()) std::abort();
      refusesOrReads([&] {
        const detail::MessageStart start = file->readStart(messages[i], 20);
        const std::vector<char> bytes = file->read(messages[i]);
        if (start.size != bytes.size() || !std::equal(start.bytes.begin(), start.bytes.end(), bytes.begin()))
          std::abort();
      });
    }
  });
}

}  // namespace gaussmap::fuzz
