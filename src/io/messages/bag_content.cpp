// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_content.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "io/messages/frame_names.h"
#include "io/messages/message_scans.h"
#include "io/messages/ros_messages.h"

namespace gaussmap::detail {
namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds kNoStamp{0};

enum class TopicUse { None, Scans, Transforms, StaticTransforms, Poses };

bool isStaticName(const std::string& name) {
  constexpr std::string_view kEnd = "tf_static";
  return name.size() >= kEnd.size() && name.compare(name.size() - kEnd.size(), kEnd.size(), kEnd) == 0;
}

/// Messages that are left out or read in another way, and the text for the first one.
struct Occurrences {
  std::size_t count = 0;
  std::string first;

  void add(const std::string& what) {
    if (count++ == 0) first = what;
  }
};

class ContentReader {
 public:
  ContentReader(const MessageFile& file, const std::filesystem::path& path, const BagOptions& options)
      : file_(file), path_(path), options_(options), groups_(groupTopics(file)) {}

  BagContent read() {
    content_.scan_topic = chooseScanTopic(path_, file_, groups_, options_.topic);
    uses_.assign(file_.topics().size(), {});
    use(content_.scan_topic, TopicUse::Scans, 0);
    if (options_.poses != BagPoses::None || !options_.pose_frame.empty()) useTransforms();
    if (options_.poses == BagPoses::Automatic || options_.poses == BagPoses::Topic) usePoseTopics();
    findLastPaths();
    const std::vector<MessagePlace>& messages = file_.messages();
    for (std::size_t i = 0; i < messages.size(); ++i) readMessage(i, messages[i]);
    requireForwardTimes();
    content_.tree.finish();
    for (BagPoseTopic& topic : content_.pose_topics) topic.poses.finish();
    const auto has_no_poses = [](const BagPoseTopic& topic) { return topic.poses.empty(); };
    auto& topics = content_.pose_topics;
    topics.erase(std::remove_if(topics.begin(), topics.end(), has_no_poses), topics.end());
    addWarnings();
    return std::move(content_);
  }

 private:
  struct Use {
    TopicUse kind = TopicUse::None;
    std::size_t index = 0;  // of the pose topic
  };

  void use(const TopicGroup& group, TopicUse kind, std::size_t index) {
    for (const std::size_t topic : group.indices) uses_[topic] = {kind, index};
  }

  void useTransforms() {
    const auto is_usual = [](const TopicGroup& group) {
      return isSameTopic(group.name, "tf") || isSameTopic(group.name, "tf_static");
    };
    const auto is_tf = [](const TopicGroup& group) { return isTransformType(group.type) && group.is_readable; };
    const auto is_named = [&](const TopicGroup& group) {
      return options_.poses == BagPoses::Topic && isSameTopic(group.name, options_.pose_topic);
    };
    const bool has_named = std::any_of(groups_.begin(), groups_.end(),
                                       [&](const TopicGroup& group) { return is_tf(group) && is_named(group); });
    const bool has_usual = std::any_of(groups_.begin(), groups_.end(),
                                       [&](const TopicGroup& group) { return is_tf(group) && is_usual(group); });
    content_.pose_topic_is_tf = has_named;
    for (const TopicGroup& group : groups_) {
      if (!is_tf(group)) continue;
      const bool is_static = isStaticName(group.name);
      const bool is_used = has_named ? is_named(group) || is_static : is_usual(group) || !has_usual;
      if (is_used) use(group, is_static ? TopicUse::StaticTransforms : TopicUse::Transforms, 0);
    }
  }

  void usePoseTopics() {
    std::vector<TopicGroup> known;
    bool is_found = options_.poses == BagPoses::Automatic;
    for (const TopicGroup& group : groups_) {
      if (!group.is_readable || (!isPoseType(group.type) && !isTransformType(group.type))) continue;
      known.push_back(group);
      if (options_.poses == BagPoses::Topic && !isSameTopic(group.name, options_.pose_topic)) continue;
      is_found = true;
      if (isTransformType(group.type) || group.messages == 0) continue;
      use(group, TopicUse::Poses, content_.pose_topics.size());
      content_.pose_topics.emplace_back();
      content_.pose_topics.back().topic = group;
    }
    if (!is_found)
      throw FileError(
          path_, "has no topic " + shown(options_.pose_topic) + " with poses; topics with poses: " + listTopics(known));
  }

  // Each message of a nav_msgs/Path holds all poses so far.
  void findLastPaths() {
    last_path_.assign(content_.pose_topics.size(), 0);
    for (std::size_t i = 0; i < file_.messages().size(); ++i)
      if (const Use& use = uses_.at(file_.messages()[i].topic); use.kind == TopicUse::Poses) last_path_[use.index] = i;
  }

  void readMessage(std::size_t number, const MessagePlace& message) {
    const Use& use = uses_.at(message.topic);
    if (use.kind == TopicUse::None) return;
    const bool is_poses = use.kind == TopicUse::Poses;
    if (is_poses && content_.pose_topics[use.index].topic.type == "nav_msgs/Path" && last_path_[use.index] != number)
      return;
    const MessageTopic& topic = file_.topics()[message.topic];
    const MessageOrigin origin = originOf(path_, file_, message);
    if (use.kind == TopicUse::Scans) return addScan(message, sizeOfScan(topic, message, origin));
    const std::vector<char> bytes = file_.read(message);
    const std::string_view view(bytes.data(), bytes.size());
    if (is_poses) {
      for (const StampedTransform& pose : decodePoses(topic.type, view, topic.encoding, origin))
        addPose(content_.pose_topics[use.index], message, pose);
    } else {
      for (const StampedTransform& transform : decodeTransforms(view, topic.encoding, origin))
        addTransform(topic, message, transform, use.kind == TopicUse::StaticTransforms);
    }
  }

  /// Reads only the start of a cloud if that is enough, because it can hold megabytes of points.
  MessageScanSize sizeOfScan(const MessageTopic& topic, const MessagePlace& message, const MessageOrigin& origin) {
    constexpr std::size_t kUsualHead = 4096;  // bytes before the points
    if (isCloudType(topic.type)) {
      const MessageStart start = file_.readStart(message, kUsualHead);
      if (const auto size = scanSizeOfStart(start, topic.encoding, origin)) return *size;
    }
    const std::vector<char> bytes = file_.read(message);
    return scanSize(topic.type, {bytes.data(), bytes.size()}, topic.encoding, origin);
  }

  nanoseconds timeOf(const MessagePlace& message, nanoseconds stamp, Occurrences& without_stamp) {
    if (stamp == kNoStamp && !options_.log_times)
      without_stamp.add(shown(file_.topics()[message.topic].name) + " at " + stampText(message.log_time));
    return safeTime(stamp == kNoStamp || options_.log_times ? message.log_time : stamp);
  }

  void addScan(const MessagePlace& message, const MessageScanSize& size) {
    const std::string frame = frameName(size.header.frame);
    const auto [found, is_new] = frames_.emplace(frame, content_.frames.size());
    if (is_new) content_.frames.push_back(frame);
    const nanoseconds time = timeOf(message, size.header.stamp, scans_without_stamp_);
    content_.scans.push_back({message, time, size.points, found->second});
    if (!size.has_range_limits) without_limits_.add(stampText(time));
    if (size.has_unused_points) with_unused_.add(stampText(time));
  }

  /// Returns true if the pose can be used.
  bool check(const MessagePlace& message, const Pose& pose) {
    const std::string fault = poseFault(pose);
    if (!fault.empty())
      faulty_.add(shown(file_.topics()[message.topic].name) + " at " + stampText(message.log_time) + ", " + fault);
    return fault.empty();
  }

  void addPose(BagPoseTopic& topic, const MessagePlace& message, const StampedTransform& pose) {
    if (!check(message, pose.pose)) return;
    const std::string parent = frameName(pose.parent), child = frameName(pose.child);
    if (!topic.poses.empty() && (topic.parent != parent || topic.child != child))
      other_frames_.add(shown(topic.topic.name) + " at " + stampText(message.log_time));
    topic.parent = parent;
    topic.child = child;
    // The poses of a path have one time of recording.
    const bool is_path = topic.topic.type == "nav_msgs/Path";
    topic.poses.add(is_path ? safeTime(pose.stamp) : timeOf(message, pose.stamp, poses_without_stamp_), pose.pose);
  }

  void addTransform(const MessageTopic& topic, const MessagePlace& message, const StampedTransform& transform,
                    bool is_static) {
    if (!check(message, transform.pose)) return;
    if (frameName(transform.parent) == frameName(transform.child)) {
      loops_.add(shown(frameName(transform.child)) + " in " + shown(topic.name));
      return;
    }
    const nanoseconds time = is_static ? kNoStamp : timeOf(message, transform.stamp, poses_without_stamp_);
    content_.tree.add(transform.parent, transform.child, time, transform.pose, is_static);
  }

  /// Throws FileError if the times of the scans step back: poses could not be told apart by their times.
  void requireForwardTimes() const {
    if (options_.log_times) return;
    nanoseconds last = nanoseconds::min();
    for (const BagScan& scan : content_.scans) {
      if (last > scan.time && last - scan.time > kMostStepBack)
        throw FileError(path_, "the times in the headers of " + shown(content_.scan_topic.name) + " step back by " +
                                   stampText(last - scan.time) + " s to " + stampText(scan.time) + kResetAdvice);
      last = std::max(last, scan.time);
    }
  }

  void addWarnings() {
    std::vector<std::string>& warnings = content_.warnings;
    const auto count = [](const Occurrences& some) { return std::to_string(some.count); };
    if (scans_without_stamp_.count > 0)
      warnings.push_back(count(scans_without_stamp_) + " scans have no time in the header, first " +
                         scans_without_stamp_.first + ". The times of recording are used instead");
    if (poses_without_stamp_.count > 0)
      warnings.push_back(count(poses_without_stamp_) + " poses have no time in the header, first " +
                         poses_without_stamp_.first + ". The times of recording are used instead");
    if (faulty_.count > 0) warnings.push_back(count(faulty_) + " poses are left out, first " + faulty_.first);
    if (loops_.count > 0)
      warnings.push_back(count(loops_) + " transforms from a frame to itself are left out, first " + loops_.first);
    if (other_frames_.count > 0)
      warnings.push_back("the frames of the poses change, first in " + other_frames_.first +
                         ". All poses are used as if they had the frames of the last one");
    if (with_unused_.count > 0)
      warnings.push_back(count(with_unused_) + " clouds have room for more points than their width says, first at " +
                         with_unused_.first + ". The points after the width are not read");
    if (without_limits_.count > 0)
      warnings.push_back(count(without_limits_) +
                         " laser scans have range_max not greater than range_min, so all ranges are used; first at " +
                         without_limits_.first);
    warnings.insert(warnings.end(), content_.tree.warnings().begin(), content_.tree.warnings().end());
  }

  const MessageFile& file_;
  const std::filesystem::path& path_;
  const BagOptions& options_;
  std::vector<TopicGroup> groups_;
  std::vector<Use> uses_;               // of each topic
  std::vector<std::size_t> last_path_;  // number of the last message of each pose topic
  std::unordered_map<std::string, std::size_t> frames_;
  Occurrences scans_without_stamp_, poses_without_stamp_, faulty_, loops_, without_limits_, with_unused_, other_frames_;
  BagContent content_;
};

}  // namespace

bool isSameTopic(const std::string& a, const std::string& b) {
  const std::size_t skip_a = !a.empty() && a.front() == '/', skip_b = !b.empty() && b.front() == '/';
  return a.compare(skip_a, std::string::npos, b, skip_b, std::string::npos) == 0;
}

BagContent readBagContent(const MessageFile& file, const std::filesystem::path& path, const BagOptions& options) {
  return ContentReader(file, path, options).read();
}

}  // namespace gaussmap::detail
