// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "common/json.h"

namespace gaussmap::app {

/// The topics of a recording as a table: name, type, messages, times and frame.
struct TopicTable {
  std::string text;
  Json json;
};
TopicTable topicsOf(const std::filesystem::path& recording);

}  // namespace gaussmap::app
