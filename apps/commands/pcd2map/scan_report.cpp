// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/scan_report.h"

#include <sstream>

#include "commands/scan_input.h"

namespace gaussmap::app {

void requirePoints(const PointCounts& counts, const Scans& scans, const Slice& slice) {
  if (counts.accepted > 0) return;
  if (counts.read == 0 && !slice.empty())
    throw std::runtime_error(nameOf(scans) + ": no point lies between the heights of --slice; give other heights");
  std::string text = nameOf(scans) + ": none of the " + std::to_string(counts.read) +
                     " points is usable: " + std::to_string(counts.non_finite) + " are not finite, " +
                     std::to_string(counts.at_sensor) + " at range 0, " + std::to_string(counts.beyond_range) +
                     " beyond --max-range";
  if (counts.too_near > 0) text += ", " + std::to_string(counts.too_near) + " nearer than --min-range";
  if (counts.outside > 0)
    text += ", " + std::to_string(counts.outside) + (slice.empty() ? " outside --crop" : " outside --slice and --crop");
  throw std::runtime_error(text);
}

Json countsJson(const PointCounts& counts) {
  Json json = {{"read", counts.read},
               {"accepted", counts.accepted},
               {"non_finite", counts.non_finite},
               {"at_sensor", counts.at_sensor},
               {"beyond_range", counts.beyond_range}};
  if (counts.too_near > 0) json["too_near"] = counts.too_near;
  if (counts.outside > 0) json["outside_crop"] = counts.outside;
  return json;
}

Json historyOf(const Scans& scans, const PointCounts& counts, const Slice& slice) {
  Json step = historyStep("pcd2map", {{"scans", scans.size()}, {"points", countsJson(counts)}});
  if (!slice.empty()) step["slice"] = slice;
  return step;
}

std::string summaryOf(const Scans& scans, const PointCounts& counts, const Slice& slice) {
  std::ostringstream text;
  text << scans.size() << (scans.size() == 1 ? " scan, " : " scans, ") << counts.accepted << " points";
  if (counts.accepted < counts.read) {
    text << " (left out: " << counts.non_finite << " not finite, " << counts.at_sensor << " at range 0, "
         << counts.beyond_range << " too far";
    if (counts.too_near > 0) text << ", " << counts.too_near << " too near";
    if (counts.outside > 0)
      text << ", " << counts.outside << (slice.empty() ? " outside the box" : " outside the slice");
    text << ")";
  }
  return text.str();
}

}  // namespace gaussmap::app
