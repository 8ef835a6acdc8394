// SPDX-License-Identifier: BSD-3-Clause
#include "commands/sensor_positions.h"

#include <filesystem>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "commands/scan_input.h"
#include "sensor/sensor_motion.h"

namespace gaussmap::app {
using namespace detail;

void requireSensorPositions(const FileScans& scans, const char* follower) {
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (!scans.files()[i].has_sensor_position)
      throw FileError(scans.files()[i].path,
                      std::string("the points are in the map frame, and the file does not say "
                                  "where the sensor was. The ") +
                          follower +
                          " follows the rays from the sensor to the points: give the positions "
                          "of the sensor with --poses FILE (or a topic of the recording) and --frame map");
  const std::optional<SameView> worst = compareViews(scans);
  if (!worst || !worst->moved()) return;
  const auto fileOf = [&](std::size_t index) { return shortNameOf(scans.info(index)); };
  const Eigen::Vector3d position = scans.info(0).pose.translation;
  std::ostringstream text;
  text << nameOf(scans) << ": all scans have the sensor position (" << position.x() << " " << position.y() << " "
       << position.z() << "), but their points show that the sensor moved, for example between " << fileOf(worst->first)
       << " and " << fileOf(worst->second) << ". The " << follower
       << " follows the rays from the sensor to the points: give the poses of the sensor with --poses FILE"
       << (scans.frame() == ScanFrame::Sensor ? ", and --frame map if the points are in the map frame already" : "");
  throw std::runtime_error(text.str());
}

}  // namespace gaussmap::app
