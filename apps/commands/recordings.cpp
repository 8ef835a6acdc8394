// SPDX-License-Identifier: BSD-3-Clause
#include "commands/recordings.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "io/formats/message_file.h"

namespace gaussmap::app {
void addFileOptions(Command& command, FileOptions& options) {
  command
      .text("--fields", options.fields,
            R"(names of the columns of a text, or of the values of a .bin file: "x y z intensity ring:u16"; "-" skips
            a column, "x:mm" and "time:ns" give units)")
      .rare();
  const char* const kHeading = "Recordings of ROS (MCAP, db3, bag)";
  RecordingOptions& recording = options.recording;
  command
      .text("--topic", recording.topic, "topic of the scans; default: the only one of PointCloud2, else of LaserScan")
      .group(kHeading);
  command
      .text("--fixed-frame", recording.fixed_frame,
            "frame that becomes the map frame; default: in tf map, else odom; of a topic of poses its frame_id")
      .group(kHeading);
  command
      .text("--pose-frame", recording.pose_frame,
            "frame whose poses the topic of --poses gives; default: its child_frame_id, else the frame of the scans")
      .group(kHeading);
  command
      .flag("--log-times", recording.log_times,
            "use the times at which messages were recorded, not those in their headers")
      .group(kHeading);
}

std::vector<std::filesystem::path> recordingsIn(const std::vector<std::string>& inputs) {
  std::vector<std::filesystem::path> recordings;
  for (const std::filesystem::path& path : listScans({inputs.begin(), inputs.end()}))
    if (detail::isMessageFile(path)) recordings.push_back(path);
  return recordings;
}

bool namesTopic(const std::string& poses) {
  if (poses == "tf") return true;
  std::error_code error;
  const bool is_name = std::all_of(poses.begin(), poses.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '/' || c == '_' || c == '~';
  });
  return is_name && !poses.empty() && poses.front() == '/' && !std::filesystem::exists(poses, error);
}

bool lacksSlash(const std::string& poses) {
  std::error_code error;
  return !poses.empty() && poses.front() != '/' && poses != "tf" && !std::filesystem::exists(poses, error) &&
         namesTopic("/" + poses);
}

}  // namespace gaussmap::app
