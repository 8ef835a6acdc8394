// SPDX-License-Identifier: BSD-3-Clause
#include "common/json.h"

#include <iostream>

#include "common/report.h"
#include "gaussmap/version.h"

namespace gaussmap::app {

void printJson(const Json& json) {
  std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

std::string validUtf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json jsonEntry(const MapMetadata& metadata, const std::string& name) {
  const auto entry = metadata.find(name);
  const Json json = entry == metadata.end() ? Json() : Json::parse(entry->second, nullptr, false);
  return json.is_discarded() ? Json() : json;
}

Json historyStep(const char* command, const Json& more) {
  Json step = {{"command", command}, {"version", GAUSSMAP_VERSION}};
  step.update(more);
  return step;
}

void addHistory(MapMetadata& metadata, const Json& step) {
  Json history = jsonEntry(metadata, "history");
  if (!history.is_array()) history = Json::array();
  history.push_back(step);
  metadata["history"] = history.dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <int D>
Json scalesOf(const GaussianMap<D>& map) {
  Json scales = Json::array();
  for (int s = 0; s < map.scales(); ++s)
    scales.push_back({{"scale", s},
                      {"cell_side", map.grid().side(s)},
                      {"cells", map.cellCount(s)},
                      {"gaussians", map.gaussianCount(s)},
                      {"weight", map.weight(s)}});
  return scales;
}
template Json scalesOf(const GaussianMap<2>&);
template Json scalesOf(const GaussianMap<3>&);

}  // namespace gaussmap::app
