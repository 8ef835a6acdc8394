// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "core/quantile.h"
#include "io/messages/frame_names.h"

namespace gaussmap::detail {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr nanoseconds kMostBetween = milliseconds(1000), kRounding = milliseconds(1);
constexpr nanoseconds kUsualLimit = milliseconds(50);  // for one scan
// Transforms can be sent by several programs, in a different order.
constexpr nanoseconds kMostDisorder = milliseconds(1000);

/// The pose of one scan, or the reason why it has no pose.
using PoseOfScan = std::function<std::optional<Pose>(const BagScan& scan, PoseLookup& lookup)>;
using Times = std::pair<nanoseconds, nanoseconds>;  // the first and the last one

class PoseAssigner {
 public:
  PoseAssigner(const std::filesystem::path& path, const BagContent& content, const BagOptions& options)
      : path_(path), content_(content), tree_(content.tree), options_(options) {
    assigned_.poses.resize(content.scans.size());
    if (options_.max_time_gap)
      gap_ = nanoseconds(static_cast<std::int64_t>(std::llround(std::clamp(*options_.max_time_gap, 0.0, 1e9) * 1e9)));
  }

  AssignedBagPoses assign() {
    if (content_.scans.empty()) return std::move(assigned_);
    switch (options_.poses) {
      case BagPoses::None:
        if (!options_.pose_frame.empty()) mountings();
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
  std::string frameText() const { return frame().empty() ? "'' (the frame_id of the scans is empty)" : shown(frame()); }
  std::string topicText() const { return shown(content_.scan_topic.name); }
  void warn(const std::string& text) { assigned_.warnings.push_back(text); }
  [[noreturn]] void fail(const std::string& text) const { throw FileError(path_, text); }

  /// Returns the fixed frame of tf for a frame; empty if no frame is above it.
  std::string fixedFrame(const std::string& of) const {
    if (!options_.fixed_frame.empty()) return frameName(options_.fixed_frame);
    const std::vector<std::string> above = tree_.above(of);
    std::string ignored;
    for (const char* const name : {"map", "odom"})
      for (const std::vector<std::string>* frames : {&above, &tree_.names()})
        for (const std::string& one : *frames)
          if (lastPart(one) == name && tree_.chain(one, of, ignored)) return one;
    return above.empty() ? (tree_.has(of) ? of : "") : above.back();
  }

  [[noreturn]] void failOfMovingFrame(const std::string& fixed) const {
    fail("--fixed-frame " + shown(fixed) + ": this is the frame of the scans, which moves; the frames are " +
         tree_.frames());
  }

  /// Throws FileError if a frame that the user names is not in tf.
  void requireFrame(const char* option, const std::string& name) const {
    if (!name.empty() && !tree_.has(name) && frameName(name) != frame())
      fail(std::string(option) + " " + shown(name) + ": tf has no such frame; the frames are " + tree_.frames());
  }

  void automatically() {
    if (isFixedFrame(frame())) return inFixedFrame();
    std::vector<const BagPoseTopic*> odometry, others;
    for (const BagPoseTopic& topic : content_.pose_topics)
      (topic.topic.type == "nav_msgs/Odometry" ? odometry : others).push_back(&topic);
    if (!tree_.empty() && odometry.empty()) {
      requireFrame("--fixed-frame", options_.fixed_frame);
      requireFrame("--pose-frame", options_.pose_frame);
    }
    const std::string used = usedFrame(), fixed = fixedFrame(used);
    if (!options_.fixed_frame.empty() && fixed == used) failOfMovingFrame(fixed);
    std::string reason;
    const std::optional<TransformChain> chain = fixed.empty() ? std::nullopt : tree_.chain(fixed, used, reason);
    if (chain && chain->moves && (isFixed(fixed, odometry) || odometry.empty())) {
      if (!isFixed(fixed, odometry))
        warn(shown(fixed) + " is taken as the fixed frame, because tf has no frame map or odom above " + shown(used) +
             "; if it moves with the robot, the poses are wrong: give others with --poses FILE");
      return fromTransforms();
    }
    if (odometry.size() == 1) return fromTopic(*odometry.front());
    std::vector<TopicGroup> known;
    for (const auto& topics : {odometry, others})
      for (const BagPoseTopic* topic : topics) known.push_back(topic->topic);
    if (known.empty() && chain && content_.scans.size() == 1 && fixed != used) return fromTransforms();
    sayWhyNone(known, chain && fixed != used ? fixed : "", reason);
  }

  /// Returns true if a frame is a fixed one: by its name, because the user names it, or because the robot moves in it.
  bool isFixed(const std::string& fixed, const std::vector<const BagPoseTopic*>& odometry) const {
    if (isFixedFrame(fixed) || !options_.fixed_frame.empty()) return true;
    std::string ignored;
    if (odometry.size() != 1 || odometry.front()->child.empty()) return false;
    const std::optional<TransformChain> chain = tree_.chain(fixed, odometry.front()->child, ignored);
    return chain && chain->moves;
  }

  /// `still`: the frame of tf in which the sensor does not move; empty if it moves in all frames.
  void sayWhyNone(const std::vector<TopicGroup>& topics, const std::string& still, const std::string& reason) {
    std::string &text = assigned_.missing.reason, &advice = assigned_.missing.advice;
    if (!topics.empty()) {
      text = "no poses: it is not clear which topic gives the poses of the sensor: " + listTopics(topics);
      advice = "choose one, for example --poses " + shown(topics.front().name);
      return;
    }
    text = "no poses: the recording has no odometry, and ";
    advice = "give a file of poses with --poses FILE";
    if (tree_.empty()) {
      text += "no tf";
    } else if (!still.empty()) {
      text += "the transform from " + shown(frame()) + " to " + shown(still) + " in tf never changes";
      advice += ", or --poses tf if the sensor did not move";
    } else if (!tree_.has(frame())) {
      text += "no transform in tf has the frame " + frameText() + " (the frames are " + tree_.frames() + ")";
      advice =
          "if the sensor is mounted on one of these frames, give it and the pose of the sensor in it: --poses tf "
          "--pose-frame NAME --extrinsic \"x y z qx qy qz qw\"; or " +
          advice;
    } else {
      text += "tf does not give the pose of " + shown(frame()) + (reason.empty() ? "" : ": " + reason);
    }
    for (const std::string& warning : content_.warnings) text += "; " + warning;
  }

  /// Returns the frame whose poses tf gives.
  std::string usedFrame() const {
    if (options_.pose_frame.empty()) return frame();
    std::string ignored;
    const std::string name = frameName(options_.pose_frame);
    return !options_.has_extrinsic && tree_.chain(name, frame(), ignored) ? frame() : name;
  }

  void fromTransforms() {
    requireFrame("--pose-frame", options_.pose_frame);
    requireFrame("--fixed-frame", options_.fixed_frame);
    const std::string used = usedFrame(), fixed = fixedFrame(used);
    if (isFixedFrame(frame()) && !options_.points_in_map) return inFixedFrame();
    std::string reason;
    if (fixed.empty())
      reason = tree_.empty()
                   ? "the recording has no messages of tf"
                   : "no transform has the frame " + frameText() + "; the frames are " + tree_.frames() +
                         "; if the sensor is mounted on one of them, use --pose-frame NAME --extrinsic \"x y z qx "
                         "qy qz qw\"";
    const std::optional<TransformChain> chain = fixed.empty() ? std::nullopt : tree_.chain(fixed, used, reason);
    if (!chain) fail("tf gives no poses for " + topicText() + ": " + reason);
    if (used != frame() && !options_.has_extrinsic && !options_.points_in_map)
      fail("--pose-frame " + shown(used) + ": tf does not give the pose of " + frameText() + " in this frame; " +
           extrinsicAdvice(used));
    if (chain->steps.empty() && options_.fixed_frame.empty()) fail("tf has no frame above " + frameText());
    if (chain->steps.empty()) failOfMovingFrame(fixed);
    if (options_.points_in_map && chain->moves)
      warn("the scans are in the frame " + frameText() +
           ", which moves, but --frame map means that the points are in a "
           "fixed frame");
    assigned_.source = "tf: " + shown(used) + " in " + shown(fixed);
    assigned_.map_frame = fixed;
    if (!chain->moves && content_.scans.size() > 1)
      warn("the transform from " + shown(used) + " to " + shown(fixed) +
           " never changes, so all scans have the same pose");
    pose_times_ = tree_.timesOf(*chain);
    fill(used == frame() ? withChains(fixed) : withChain(*chain));
  }

  /// The frame of the scans is a fixed frame: the sensor is elsewhere.
  void inFixedFrame() {
    if (options_.points_in_map) return positions();
    std::string reason;
    if (options_.poses != BagPoses::Automatic)
      warn("the points of " + topicText() + " are in the fixed frame " + shown(frame()) +
           ", so the poses are not used; with --frame map they are the positions of the sensor");
    std::string fixed = options_.fixed_frame.empty() ? frame() : frameName(options_.fixed_frame);
    for (const std::string& above : tree_.above(frame()))
      if (options_.fixed_frame.empty() && lastPart(above) == "map") fixed = above;
    const std::optional<TransformChain> chain = tree_.chain(fixed, frame(), reason);
    if (!chain) fail("--fixed-frame " + shown(fixed) + ": " + reason);
    assigned_.in_fixed_frame = true;
    assigned_.map_frame = fixed;
    assigned_.source = "none needed: the points of " + topicText() + " are in the fixed frame " + shown(frame()) +
                       (fixed == frame() ? "" : " (tf moves them to " + shown(fixed) + ")") +
                       "; the positions of the sensor are unknown";
    fill(withChains(fixed));
  }

  /// The positions of the sensor for points in a fixed frame, from the only odometry or from the topic that is named.
  void positions() {
    assigned_.in_fixed_frame = true;
    assigned_.map_frame = frame();
    assigned_.source = "none: the points of " + topicText() + " are in the fixed frame " + shown(frame());
    for (std::optional<Pose>& pose : assigned_.poses) pose = Pose();
    std::vector<const BagPoseTopic*> found;
    for (const BagPoseTopic& topic : content_.pose_topics)
      if (options_.poses == BagPoses::Topic || topic.topic.type == "nav_msgs/Odometry") found.push_back(&topic);
    std::string ignored;
    if (found.size() != 1 || !tree_.chain(frame(), found.front()->parent, ignored)) return;
    positionsFrom(*found.front());
  }

  void positionsFrom(const BagPoseTopic& topic) {
    std::string reason;
    const std::optional<TransformChain> to_points = tree_.chain(frame(), topic.parent, reason);
    if (!to_points)
      fail("the positions of " + shown(topic.topic.name) + " are in the frame " + shown(topic.parent) + ": " + reason);
    assigned_.in_fixed_frame = false;
    assigned_.map_frame = frame();
    assigned_.source = "positions from " + shown(topic.topic.name) + " (" + topic.topic.type + ") in " + shown(frame());
    fill(withTopic(topic, PoseOfScan(), *to_points));
  }

  void fromNamedTopic() {
    if (content_.pose_topic_is_tf) return fromTransforms();
    if (content_.pose_topics.empty()) fail("topic " + shown(options_.pose_topic) + " has no poses that can be used");
    fromTopic(content_.pose_topics.front());
  }

  void fromTopic(const BagPoseTopic& topic) {
    const std::string name = shown(topic.topic.name);
    if (options_.points_in_map) return positionsFrom(topic);
    const std::string child = options_.pose_frame.empty() ? topic.child : frameName(options_.pose_frame);
    if (isFixedFrame(frame()) || (frame() == topic.parent && child != frame())) return inFixedFrame();
    if (child.empty()) requireNoRobot(name);
    std::string reason;
    const bool is_connected = !child.empty() && tree_.chain(child, frame(), reason);
    // An extrinsic replaces the transform of tf.
    const bool is_moved = is_connected && child != frame() && !options_.has_extrinsic;
    if (!child.empty() && !is_connected && !options_.has_extrinsic)
      fail(name + " gives the poses of " + shown(child) + ", but " +
           (tree_.empty() ? "the recording has no tf that gives" : "tf does not give") + " the pose of " + frameText() +
           " in " + shown(child) + (tree_.empty() ? "" : " (the frames of tf are " + tree_.frames() + ")") + "; " +
           extrinsicAdvice(child));
    const std::string fixed = options_.fixed_frame.empty() ? topic.parent : frameName(options_.fixed_frame);
    const std::optional<TransformChain> to_fixed = tree_.chain(fixed, topic.parent, reason);
    if (!to_fixed && !options_.fixed_frame.empty()) fail("--fixed-frame " + shown(fixed) + ": " + reason);
    if (!to_fixed) fail("the poses of " + name + " are in the frame " + shown(topic.parent) + ": " + reason);
    assigned_.source =
        name + " (" + topic.topic.type + "): " + shown(child.empty() ? frame() : child) + " in " + shown(fixed);
    assigned_.map_frame = fixed;
    if (is_moved) assigned_.source += ", then " + shown(child) + " -> " + shown(frame()) + " of tf";
    fill(withTopic(topic, is_moved ? withChains(child) : PoseOfScan(), *to_fixed));
  }

  /// A topic does not say whose poses it gives. Throws FileError if they can be those of a robot that carries the
  /// sensor.
  void requireNoRobot(const std::string& topic) {
    std::string robot, ignored;
    for (const std::string& above : tree_.above(frame())) {
      const std::optional<TransformChain> chain = tree_.chain(above, frame(), ignored);
      if (!chain || chain->moves || isFixedFrame(above)) break;
      robot = above;
    }
    if (!robot.empty() && !options_.has_extrinsic)
      fail(topic + " does not say whose poses it gives; use --pose-frame " + shown(robot) +
           " if they are those of the robot, or --pose-frame " + shown(frame()) + " if they are those of the sensor");
    if (robot.empty() && !options_.has_extrinsic)
      warn(topic + " does not say whose poses it gives. They are used as those of the frame " + shown(frame()) +
           " of the scans; if they are those of the robot, give the pose of the sensor in it with --extrinsic");
  }

  std::string extrinsicAdvice(const std::string& carrier) const {
    const bool is_optical =
        frame().find("optical") != std::string::npos && carrier.find("optical") == std::string::npos;
    return "give its pose in " + shown(carrier) + " with --extrinsic \"x y z qx qy qz qw\"" +
           (is_optical ? " (\"0 0 0 -0.5 0.5 -0.5 0.5\" turns the axes of a camera)" : "") +
           ", or --extrinsic none if both are the same";
  }

  /// Poses from a pose file are those of a frame on which the sensor is mounted.
  void mountings() {
    requireFrame("--pose-frame", options_.pose_frame);
    const std::string carrier = frameName(options_.pose_frame);
    std::string reason;
    if (carrier != frame() && !tree_.chain(carrier, frame(), reason))
      fail("--pose-frame " + shown(carrier) + ": " + reason);
    fill(withChains(carrier));
  }

  PoseTimeLimits transformLimits() const {
    return gap_ ? PoseTimeLimits{std::max(kMostBetween, 2 * *gap_), std::max(kRounding, *gap_)}
                : PoseTimeLimits{kMostBetween, kRounding};
  }

  PoseTimeLimits topicLimits() const {
    std::vector<nanoseconds> times;
    for (const BagScan& scan : content_.scans) times.push_back(scan.time);
    const std::optional<nanoseconds> step = medianStep(std::move(times));
    const nanoseconds usual = step ? *step / 2 : kUsualLimit,
                      between = 4 * std::min<nanoseconds>(usual, std::chrono::hours(1));
    return gap_ ? PoseTimeLimits{std::max(between, 2 * *gap_), *gap_} : PoseTimeLimits{between, usual};
  }

  /// Returns the transform of a chain. Throws FileError if the times of its transforms step back.
  PoseOfScan withChain(const TransformChain& chain) const {
    try {
      if (!options_.log_times) tree_.requireForwardTimes(chain, kMostDisorder);
    } catch (const std::runtime_error& error) {
      fail(std::string(error.what()) + kResetAdvice);
    }
    return [this, chain, limits = transformLimits()](const BagScan& scan, PoseLookup& lookup) {
      return tree_.pose(chain, scan.time, limits, lookup);
    };
  }

  /// Returns the pose of the frame of a scan in the frame `target`, from tf.
  PoseOfScan withChains(const std::string& target) const {
    std::vector<PoseOfScan> poses(content_.frames.size());
    std::vector<std::string> reasons(content_.frames.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      if (const auto chain = tree_.chain(target, content_.frames[i], reasons[i])) poses[i] = withChain(*chain);
    return [poses, reasons](const BagScan& scan, PoseLookup& lookup) -> std::optional<Pose> {
      if (poses[scan.frame]) return poses[scan.frame](scan, lookup);
      lookup.reason = reasons[scan.frame];
      return std::nullopt;
    };
  }

  /// Returns the pose of a topic, then that of the sensor in the frame of the topic (if there is one), both moved by
  /// `to_fixed`.
  PoseOfScan withTopic(const BagPoseTopic& topic, const PoseOfScan& to_sensor, const TransformChain& to_fixed) {
    pose_times_ = {topic.poses.first(), topic.poses.last()};
    if (!options_.log_times && topic.poses.stepBack() > kMostStepBack)
      fail("the times of " + shown(topic.topic.name) + " step back by " + stampText(topic.poses.stepBack()) + " s" +
           kResetAdvice);
    return [&topic, to_sensor, moved = withChain(to_fixed), limits = topicLimits()](
               const BagScan& scan, PoseLookup& lookup) -> std::optional<Pose> {
      const std::optional<Pose> pose = topic.poses.at(scan.time, limits, lookup);
      if (!pose) {
        lookup.reason = "its time is " + stampText(topic.poses.distance(scan.time)) +
                        " s from the nearest pose, but the limit is " + stampText(limits.nearest) +
                        " s; the times of the poses are " + stampText(topic.poses.first()) + " to " +
                        stampText(topic.poses.last());
        return std::nullopt;
      }
      const std::optional<Pose> sensor = to_sensor ? to_sensor(scan, lookup) : Pose();
      const std::optional<Pose> fixed = sensor ? moved(scan, lookup) : std::nullopt;
      if (!fixed) return std::nullopt;
      const Pose product = *fixed * *pose * *sensor;
      lookup.reason = poseFault(product);
      return lookup.reason.empty() ? std::optional(product) : std::nullopt;
    };
  }

  void fill(const PoseOfScan& pose_of) {
    std::size_t missing = 0, held = 0;
    nanoseconds farthest{0};
    bool is_outside = true;
    std::string first;
    for (std::size_t i = 0; i < content_.scans.size(); ++i) {
      PoseLookup lookup;
      assigned_.poses[i] = pose_of(content_.scans[i], lookup);
      if (assigned_.poses[i]) {
        held += lookup.to_nearest > kRounding;
        farthest = std::max(farthest, lookup.to_nearest);
        continue;
      }
      is_outside = is_outside && lookup.is_outside;
      if (missing++ == 0) first = topicText() + " " + stampText(content_.scans[i].time) + ": " + lookup.reason;
    }
    if (held > 0)
      warn(std::to_string(held) + " of " + std::to_string(content_.scans.size()) +
           (held == 1 ? " scans has" : " scans have") + " the pose of another time, at most " + stampText(farthest) +
           " s away, because a pose before or after them is missing or too far away");
    if (missing > 0) sayMissing(missing, first, is_outside);
  }

  void sayMissing(std::size_t missing, const std::string& first, bool is_outside) {
    const std::size_t all = content_.scans.size();
    MissingPoses& said = assigned_.missing;
    said.reason = std::to_string(missing) + " of " + std::to_string(all) +
                  (missing == 1 ? " scans has" : " scans have") + " no pose, first " + first;
    if (missing < all) {
      said.advice = std::string("use --skip-without-pose to leave such scans out") +
                    (is_outside ? "" : ", or --max-time-gap to take the nearest poses");
      return;
    }
    assigned_.source.clear();
    said.advice = clocksDiffer() ? "the times in the headers of the scans and of the poses are from different clocks: "
                                   "use --log-times"
                                 : "check the times, or give a file of poses with --poses FILE";
  }

  /// Returns true if the scans and the poses have no time in common, although they were recorded together.
  bool clocksDiffer() const {
    constexpr nanoseconds kFar = std::chrono::seconds(10);
    if (!pose_times_ || options_.log_times) return false;
    const auto [low, high] = std::minmax_element(content_.scans.begin(), content_.scans.end(),
                                                 [](const BagScan& a, const BagScan& b) { return a.time < b.time; });
    return low->time > pose_times_->second + kFar || high->time + kFar < pose_times_->first;
  }

  const std::filesystem::path& path_;
  const BagContent& content_;
  const TransformTree& tree_;
  const BagOptions& options_;
  std::optional<nanoseconds> gap_;
  std::optional<Times> pose_times_;
  AssignedBagPoses assigned_;
};

}  // namespace

AssignedBagPoses assignBagPoses(const std::filesystem::path& path, const BagContent& content,
                                const BagOptions& options) {
  return PoseAssigner(path, content, options).assign();
}

}  // namespace gaussmap::detail
