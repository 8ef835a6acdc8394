// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {

/// Adds --fields, --topic and the other options that say what files alone do not say.
void addFileOptions(Command& command, FileOptions& options);

/// Returns the recordings of ROS among the inputs: files, and folders with metadata.yaml.
std::vector<std::filesystem::path> recordingsIn(const std::vector<std::string>& inputs);

/// Returns true if the value of --poses is "tf" or a topic, not a file.
bool namesTopic(const std::string& poses);
/// Returns true if the value of --poses is not a file, but would be the name of a topic with a slash in front.
bool lacksSlash(const std::string& poses);

}  // namespace gaussmap::app
