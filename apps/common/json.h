// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "gaussmap/io/gmap/map_file.h"

namespace gaussmap::app {

using Json = nlohmann::ordered_json;

/// Prints JSON on stdout. JSON must be UTF-8, so other bytes (file names can contain them) are replaced.
void printJson(const Json& json);

/// Returns an entry of the metadata of a map; null if it does not exist or is not JSON.
Json jsonEntry(const MapMetadata& metadata, const std::string& name);

/// Returns a step of the history: {"command", "version"} and the members of `more`.
Json historyStep(const char* command, const Json& more = Json::object());
/// Adds a step to the history in the metadata of a map file.
void addHistory(MapMetadata& metadata, const Json& step);

/// Returns side, cells, Gaussians and weight of every scale.
template <int D>
Json scalesOf(const GaussianMap<D>& map);

}  // namespace gaussmap::app
