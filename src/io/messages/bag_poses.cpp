// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace gaussmap::detail {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr nanoseconds kMostBetween = milliseconds(1000), kRounding = milliseconds(1);
constexpr nanoseconds kUsualLimit = milliseconds(50);  // for one scan
// Frames that do not move with a sensor, by convention.
constexpr std::array<const char*, 5> kFixedFrames = {"map", "odom", "world", "earth", "camera_init"};

bool isFixedFrame(const std::string& frame) {
  return std::find(kFixedFrames.begin(), kFixedFrames.end(), frame) != kFixedFrames.end();
}

/// The pose of one scan, or the reason why there is none.
using PoseOfScan = std::function<std::optional<Pose>(const BagScan& scan, std::string& reason)>;

class PoseAssigner {
 public:
  PoseAssigner(const std::filesystem::path& path, const BagContent& content, const BagOptions& options)
      : path_(path), content_(content), options_(options) {
    assigned_.poses.resize(content.scans.size());
    if (options_.max_time_gap)
      gap_ = nanoseconds(static_cast<std::int64_t>(std::llround(std::clamp(*options_.max_time_gap, 0.0, 1e9) * 1e9)));
  }

  AssignedBagPoses assign() {
    if (content_.scans.empty()) return std::move(assigned_);
    switch (options_.poses) {
      case BagPoses::None:
        break;
      case BagPoses::Tf:
        fromTransforms();
        break;
      case BagPoses::Topic:
        fromNamedTopic();
        break;
      default:
        automatically();
    }
    return std::move(assigned_);
  }

 private:
  const std::string& frame() const { return content_.frames.front(); }  // of the first scan
  void warn(const std::string& text) { assigned_.warnings.push_back(text); }

  /// Returns the fixed frame of tf; empty if the sensor frame is not below one.
  std::string fixedFrame() const {
    if (!options_.fixed_frame.empty()) return frameName(options_.fixed_frame);
    std::string ignored;
    for (const char* const name : {"map", "odom"})
      if (content_.tree.has(name) && content_.tree.chain(name, frame(), ignored)) return name;
    return content_.tree.rootOf(frame()).value_or("");
  }

  void automatically() {
    const std::string fixed = fixedFrame();
    std::string reason;
    const std::optional<TransformChain> chain =
        fixed.empty() ? std::nullopt : content_.tree.chain(fixed, frame(), reason);
    std::vector<const BagPoseTopic*> odometry, others;
    for (const BagPoseTopic& topic : content_.pose_topics)
      (topic.topic.type == "nav_msgs/Odometry" ? odometry : others).push_back(&topic);
    // Without odometry in tf, the root of the tree is the robot, on which a sensor can move.
    const bool is_fixed = isFixedFrame(fixed) || !options_.fixed_frame.empty();
    if (chain && is_fixed && (chain->moves || fixed == frame())) return fromTransforms();
    if (odometry.size() == 1) return fromTopic(*odometry.front());
    if (chain && chain->moves && odometry.empty()) {
      warn(shown(fixed) + " is taken as the fixed frame, because tf has no frame map or odom above " + shown(frame()) +
           "; if it is on the robot, the recording has no poses");
      return fromTransforms();
    }
    std::vector<TopicGroup> known;
    for (const auto& topics : {odometry, others})
      for (const BagPoseTopic* topic : topics) known.push_back(topic->topic);
    std::string& text = assigned_.missing;
    if (!known.empty()) {
      text = "no poses: choose the topic with the poses of the sensor: " + listTopics(known) +
             ", for example --poses " + shown(known.front().name);
      return;
    }
    if (chain && content_.scans.size() == 1 && fixed != frame()) return fromTransforms();
    text = "no poses: the recording has no odometry, and ";
    if (content_.tree.empty())
      text += "no tf";
    else if (chain && fixed != frame())
      text += "the transform from " + shown(frame()) + " to " + shown(fixed) + " in tf does not move";
    else if (!content_.tree.has(frame()))
      text += "no transform in tf has the frame " + shown(frame()) + " (the frames are " + content_.tree.frames() + ")";
    else
      text += "tf does not give the pose of " + shown(frame()) + (reason.empty() ? "" : ": " + reason);
    text += "; give a file of poses with --poses FILE";
    if (chain && fixed != frame()) text += ", or --poses tf if the sensor did not move";
  }

  void fromTransforms() {
    const std::string fixed = fixedFrame();
    std::string reason;
    if (fixed.empty())
      reason = content_.tree.empty()
                   ? "the recording has no messages of tf"
                   : "no transform has the frame " + shown(frame()) + "; the frames are " + content_.tree.frames();
    const std::optional<TransformChain> chain =
        fixed.empty() ? std::nullopt : content_.tree.chain(fixed, frame(), reason);
    if (!chain) throw FileError(path_, "tf gives no poses for " + shown(content_.scan_topic.name) + ": " + reason);
    assigned_.source = "tf: " + shown(frame()) + " in " + shown(fixed);
    assigned_.in_fixed_frame = chain->steps.empty();
    if (assigned_.in_fixed_frame)
      warn("the points of " + shown(content_.scan_topic.name) + " are in the fixed frame " + shown(fixed) +
           ", so they are not moved, and the positions of the sensor are unknown");
    else if (!chain->moves && content_.scans.size() > 1)
      warn("the transform from " + shown(frame()) + " to " + shown(fixed) +
           " does not move, so all scans have the same pose");
    fill(withChains(fixed));
  }

  void fromNamedTopic() {
    if (content_.pose_topic_is_tf) return fromTransforms();
    if (content_.pose_topics.empty())
      throw FileError(path_, "topic " + shown(options_.pose_topic) + " has no poses that can be used");
    fromTopic(content_.pose_topics.front());
  }

  void fromTopic(const BagPoseTopic& topic) {
    const std::string name = shown(topic.topic.name);
    const std::string child = options_.pose_frame.empty() ? topic.child : frameName(options_.pose_frame);
    assigned_.source = name + " (" + topic.topic.type + ")";
    if (frame() == topic.parent && child != frame()) {
      assigned_.source += ": the points are in its frame " + shown(topic.parent);
      assigned_.in_fixed_frame = true;
      warn("the points of " + shown(content_.scan_topic.name) + " are in the frame " + shown(topic.parent) +
           " of the poses of " + name + ", so they are not moved, and the positions of the sensor are unknown");
      return fill([](const BagScan&, std::string&) { return Pose(); });
    }
    std::string reason;
    std::string source = frame();  // whose poses are wanted: those of the sensor, or of the child if tf lacks it
    if (child.empty()) {
      warn(name + " does not say whose poses it gives. They are used as those of the frame " + shown(frame()) +
           " of the scans");
    } else if (!content_.tree.chain(child, frame(), reason)) {
      warn(name + " gives the poses of " + shown(child) + ", but the scans are in the frame " + shown(frame()) + ": " +
           reason + ". The poses are used as they are; --extrinsic may be needed");
      source = child;
    }
    const std::string fixed = options_.fixed_frame.empty() ? topic.parent : frameName(options_.fixed_frame);
    const std::optional<TransformChain> to_fixed = content_.tree.chain(fixed, topic.parent, reason);
    if (!to_fixed)
      throw FileError(path_, "the poses of " + name + " are in the frame " + shown(topic.parent) + ": " + reason);
    assigned_.source += ": " + shown(child.empty() ? frame() : child) + " in " + shown(fixed);
    if (!child.empty() && source == frame() && child != frame())
      assigned_.source += ", then " + shown(child) + " -> " + shown(frame()) + " of tf";
    const PoseTimeLimits limits = topicLimits();
    const PoseOfScan to_child = child.empty() || source != frame() ? PoseOfScan() : withChains(child);
    fill([this, &topic, limits, to_child, to_fixed](const BagScan& scan, std::string& why) -> std::optional<Pose> {
      std::optional<Pose> pose = topic.poses.at(scan.time, limits);
      if (!pose) {
        why = "its time is " + stampText(topic.poses.distance(scan.time)) + " s from the nearest pose, at most " +
              stampText(limits.hold) + " s are allowed. The poses are from " + stampText(topic.poses.first()) + " to " +
              stampText(topic.poses.last());
        return std::nullopt;
      }
      if (to_child) {
        const std::optional<Pose> sensor = to_child(scan, why);
        if (!sensor) return std::nullopt;
        pose = *pose * *sensor;
      }
      const std::optional<Pose> moved = content_.tree.pose(*to_fixed, scan.time, transformLimits(), why);
      if (!moved) return std::nullopt;
      pose = *moved * *pose;
      why = poseFault(*pose);
      return why.empty() ? pose : std::nullopt;
    });
  }

  PoseTimeLimits transformLimits() const {
    return gap_ ? PoseTimeLimits{*gap_, *gap_} : PoseTimeLimits{kMostBetween, kRounding};
  }

  PoseTimeLimits topicLimits() const {
    if (gap_) return {4 * *gap_, *gap_};
    std::vector<nanoseconds> times;
    for (const BagScan& scan : content_.scans) times.push_back(scan.time);
    const std::optional<nanoseconds> step = medianInterval(std::move(times));
    const nanoseconds limit = step ? *step / 2 : kUsualLimit;
    return {4 * std::min<nanoseconds>(limit, std::chrono::hours(1)), limit};
  }

  /// Returns the pose of the frame of a scan in the frame `target`, from tf.
  PoseOfScan withChains(const std::string& target) const {
    std::vector<std::optional<TransformChain>> chains;
    std::vector<std::string> reasons(content_.frames.size());
    for (std::size_t i = 0; i < content_.frames.size(); ++i)
      chains.push_back(content_.tree.chain(target, content_.frames[i], reasons[i]));
    const PoseTimeLimits limits = transformLimits();
    return [this, chains, reasons, limits](const BagScan& scan, std::string& why) -> std::optional<Pose> {
      if (chains[scan.frame]) return content_.tree.pose(*chains[scan.frame], scan.time, limits, why);
      why = reasons[scan.frame];
      return std::nullopt;
    };
  }

  void fill(const PoseOfScan& pose_of) {
    std::size_t missing = 0;
    std::string first;
    for (std::size_t i = 0; i < content_.scans.size(); ++i) {
      std::string reason;
      assigned_.poses[i] = pose_of(content_.scans[i], reason);
      if (!assigned_.poses[i] && missing++ == 0)
        first = shown(content_.scan_topic.name) + " " + stampText(content_.scans[i].time) + ": " + reason;
    }
    if (missing == 0) return;
    const std::size_t all = content_.scans.size();
    assigned_.missing = std::to_string(missing) + " of " + std::to_string(all) +
                        (missing == 1 ? " scan has" : " scans have") + " no pose, first " + first + "; " +
                        (missing < all ? "use --skip-without-pose to leave such scans out, " : "use ") +
                        "--max-time-gap to allow more time between scans and poses, or --poses FILE";
    if (missing == all) assigned_.source.clear();
  }

  const std::filesystem::path& path_;
  const BagContent& content_;
  const BagOptions& options_;
  std::optional<nanoseconds> gap_;
  AssignedBagPoses assigned_;
};

}  // namespace

AssignedBagPoses assignBagPoses(const std::filesystem::path& path, const BagContent& content,
                                const BagOptions& options) {
  return PoseAssigner(path, content, options).assign();
}

}  // namespace gaussmap::detail
