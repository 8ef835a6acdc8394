// SPDX-License-Identifier: BSD-3-Clause
#include "commands/dropped_fields.h"

#include <algorithm>
#include <string>
#include <vector>

#include "common/report.h"
#include "io/files/text.h"

namespace gaussmap::app {
namespace {

const std::vector<std::string> kIntensityFields = {"intensity", "intensities", "reflectivity", "reflectance",
                                                   "remission"};
const std::vector<std::string> kColourFields = {"rgb", "rgba", "r", "red"};

bool hasValue(const std::vector<std::string>& values, const std::vector<std::string>& names, std::string& found) {
  for (const std::string& value : values) {
    if (std::find(names.begin(), names.end(), detail::lowerCase(value)) == names.end()) continue;
    found = value;
    return true;
  }
  return false;
}

}  // namespace

void noteDroppedFields(const FileScans& scans) {
  if (scans.size() == 0) return;
  const std::vector<std::string> values = scans.open(0)->valueNames();
  std::string intensity, colour;
  const bool has_intensity = hasValue(values, kIntensityFields, intensity);
  const bool has_colour = hasValue(values, kColourFields, colour);
  if (!has_intensity && !has_colour) return;
  const std::string both = has_intensity && has_colour ? " and " : "";
  note("the map keeps only geometry: the field" + std::string(both.empty() ? " " : "s ") + intensity + both + colour +
       " of the scans " + (both.empty() ? "is" : "are") + " not in the map");
}

}  // namespace gaussmap::app
