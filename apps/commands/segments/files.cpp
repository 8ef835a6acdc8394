// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "commands/segments/segments.h"
#include "common/usage.h"
#include "gaussmap/io/export/segment_files.h"

namespace gaussmap::app {

void checkSegmentsName(const std::string& path) {
  const std::string extension = endingOf(path);
  if (extension != ".pcd" && extension != ".svg" && extension != ".geojson" && extension != ".csv")
    throw UsageError("'" + path + "': the name must end in .pcd, .svg, .geojson or .csv");
}

void writeSegments(const std::string& path, const FittedSegments& fitted) {
  const std::string extension = endingOf(path);
  if (extension == ".pcd") return saveSegmentsPcd(path, fitted.map);
  if (extension == ".geojson") return saveSegmentsGeoJson(path, fitted.map);
  if (extension == ".csv") return saveSegmentsCsv(path, fitted.map);
  drawSegments(fitted.map, fitted.picture, path);
}

}  // namespace gaussmap::app
