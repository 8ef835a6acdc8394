// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "gaussmap/io/gmap/map_file.h"

namespace gaussmap::app {

using Json = nlohmann::ordered_json;

/// To stdout. File names need not be UTF-8, but JSON must be: their other bytes are replaced.
void printJson(const Json& json);

/// An entry of the metadata of a map; null if it does not exist or is not JSON.
Json jsonEntry(const MapMetadata& metadata, const std::string& name);

/// A step of the history: {"command", "version"}, then `more`.
Json historyStep(const char* command, const Json& more = Json::object());
/// Adds a step to the history in the metadata of a map file.
void addHistory(MapMetadata& metadata, const Json& step);

/// Cells and Gaussians of every scale.
Json scalesOf(const GaussianMap<3>& map);

}  // namespace gaussmap::app
