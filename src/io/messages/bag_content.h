// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/messages/bag_scans.h"
#include "io/messages/bag_topics.h"
#include "io/messages/timed_poses.h"
#include "io/messages/transform_tree.h"

namespace gaussmap::detail {

/// A scan of a recording, without its points and its pose.
struct BagScan {
  MessagePlace place;
  std::chrono::nanoseconds time{0};
  std::size_t points = 0;
  std::size_t frame = 0;  ///< index in BagContent::frames
};

/// The poses of one topic.
struct BagPoseTopic {
  TopicGroup topic;
  TimedPoses poses;
  std::string parent, child;  ///< frames of the last message; child: empty if the type has none
};

/// What a recording says about scans and poses.
struct BagContent {
  TopicGroup scan_topic;
  std::vector<BagScan> scans;       ///< in the order of recording
  std::vector<std::string> frames;  ///< of the scans, without leading slashes
  TransformTree tree;
  std::vector<BagPoseTopic> pose_topics;  ///< with at least one message
  bool pose_topic_is_tf = false;          ///< true: BagOptions::pose_topic holds transforms
  std::vector<std::string> warnings;
};

/// Returns true if two names of topics are equal, apart from a slash in front.
bool isSameTopic(const std::string& a, const std::string& b);

/// Reads the headers of all scans, and the poses that the options ask for, in one pass. Throws FileError.
BagContent readBagContent(const MessageFile& file, const std::filesystem::path& path, const BagOptions& options);

}  // namespace gaussmap::detail
