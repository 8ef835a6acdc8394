// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gaussmap/core/pose.h"
#include "io/messages/timed_poses.h"

namespace gaussmap::detail {

/// Returns the name of a frame without leading slashes, which ROS 1 allowed.
std::string frameName(const std::string& frame);

/// The way from one frame to another, as a list of transforms. Made by TransformTree.
struct TransformChain {
  struct Step {
    std::size_t link = 0;  ///< index of the transform in the tree
    bool inverse = false;
  };
  std::vector<Step> steps;  ///< from the target to the source: the product of all of them maps source to target
  bool moves = false;       ///< true: a transform has different values at different times
};

/// The tree of frames that the messages of /tf and /tf_static describe. Add all transforms, then call finish() once;
/// then all functions are thread-safe.
class TransformTree {
 public:
  /// Adds the pose of `child` in the frame `parent`. A static transform is valid at all times.
  void add(const std::string& parent, const std::string& child, std::chrono::nanoseconds time, const Pose& pose,
           bool is_static);
  /// Sorts the transforms by time, and gives each frame one parent: the last one in the recording.
  void finish();

  bool empty() const { return frames_.empty(); }
  /// Returns true if a transform has this frame as child or parent.
  bool has(const std::string& frame) const { return indices_.count(frameName(frame)) > 0; }
  /// Returns the frames above `frame`, the nearest first; empty if no frame is above it, or if the frames form a cycle.
  std::vector<std::string> above(const std::string& frame) const;
  /// Returns the names of all frames.
  const std::vector<std::string>& names() const { return frames_; }
  /// Returns the names of the frames for messages: "base_link, lidar, odom".
  std::string frames() const;
  /// Returns the way from `source` to `target`: pose(chain, time) maps points of `source` to `target`. Returns
  /// std::nullopt if tf does not give it, and says why in `reason`: a frame is missing, the frames are not connected,
  /// or the parents of a frame form a cycle.
  std::optional<TransformChain> chain(const std::string& target, const std::string& source, std::string& reason) const;
  /// Returns the transform of a chain at a time. Returns std::nullopt if a transform is not known at that time, and
  /// says which one in lookup.reason. Takes O(log n) per transform of the chain.
  ///
  /// A transform that has the same value in the whole recording is valid at all times.
  std::optional<Pose> pose(const TransformChain& chain, std::chrono::nanoseconds time, const PoseTimeLimits& limits,
                           PoseLookup& lookup) const;
  /// Returns the first and the last time of the moving transforms of a chain; std::nullopt if all are static.
  std::optional<std::pair<std::chrono::nanoseconds, std::chrono::nanoseconds>> timesOf(
      const TransformChain& chain) const;
  /// Throws std::runtime_error if the times of a moving transform of the chain step back by more than `limit` in the
  /// order of the recording.
  void requireForwardTimes(const TransformChain& chain, std::chrono::nanoseconds limit) const;

  /// Returns warnings about the tree, for example of a frame with several parents. Call after finish().
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  struct Link {  // the transforms of a pair of frames
    std::size_t parent = 0, child = 0;
    TimedPoses poses;           // of /tf
    std::optional<Pose> fixed;  // of /tf_static
    bool fixed_changes = false;
    std::size_t last = 0;  // number of the last message
  };

  std::size_t index(const std::string& frame);
  std::string linkName(const Link& link) const;
  std::optional<std::vector<std::size_t>> linksAbove(std::size_t frame, std::string& reason) const;

  std::vector<std::string> frames_;
  std::unordered_map<std::string, std::size_t> indices_;
  std::vector<Link> links_;
  std::unordered_map<std::uint64_t, std::size_t> link_of_pair_;
  std::vector<std::optional<std::size_t>> link_above_;  // of each frame
  std::size_t added_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace gaussmap::detail
