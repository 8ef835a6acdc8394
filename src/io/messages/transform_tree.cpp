// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/transform_tree.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/messages/wire_reader.h"

namespace gaussmap::detail {
namespace {

// No robot has longer chains. The limit bounds the time of a lookup in a hostile file.
constexpr std::size_t kLongestChain = 256;
constexpr std::size_t kMostNamed = 20;  // frames in a message
constexpr std::size_t kMostWarnings = 10;

}  // namespace

std::string frameName(const std::string& frame) {
  return frame.substr(std::min(frame.find_first_not_of('/'), frame.size()));
}

std::string TransformTree::linkName(const Link& link) const {
  return shown(frames_[link.parent]) + " -> " + shown(frames_[link.child]);
}

std::size_t TransformTree::index(const std::string& frame) {
  const std::string name = frameName(frame);
  const auto [found, is_new] = indices_.emplace(name, frames_.size());
  if (is_new) frames_.push_back(name);
  return found->second;
}

void TransformTree::add(const std::string& parent, const std::string& child, std::chrono::nanoseconds time,
                        const Pose& pose, bool is_static) {
  const std::size_t above = index(parent), below = index(child);
  const auto [found, is_new] = link_of_pair_.emplace(std::uint64_t{above} << 32 | below, links_.size());
  if (is_new) {
    links_.emplace_back();
    links_.back().parent = above;
    links_.back().child = below;
  }
  Link& link = links_[found->second];
  link.last = added_++;
  if (!is_static) {
    link.poses.add(time, pose);
    return;
  }
  if (link.fixed && ((link.fixed->translation - pose.translation).norm() > 1e-6 ||
                     (link.fixed->rotation.coeffs() - normalised(pose).rotation.coeffs()).norm() > 1e-6))
    link.fixed_changes = true;
  link.fixed = normalised(pose);
}

void TransformTree::finish() {
  link_above_.assign(frames_.size(), std::nullopt);
  std::vector<bool> has_several(frames_.size(), false);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = links_[i];
    link.poses.finish();
    std::optional<std::size_t>& above = link_above_[link.child];
    if (above) has_several[link.child] = true;
    if (!above || links_[*above].last < link.last) above = i;
  }
  for (std::size_t i = 0; i < links_.size() && warnings_.size() < kMostWarnings; ++i) {
    const Link& link = links_[i];
    if (link_above_[link.child] != i)
      warnings_.push_back("frame " + shown(frames_[link.child]) + " has the parents " + shown(frames_[link.parent]) +
                          " and " + shown(frames_[links_[*link_above_[link.child]].parent]) +
                          ". The last one in the recording is used");
    else if (link.fixed_changes)
      warnings_.push_back("the static transform " + linkName(link) +
                          " is given with different values. The last one is used");
  }
}

std::string TransformTree::frames() const {
  std::vector<std::string> names = frames_;
  const std::size_t named = std::min(names.size(), kMostNamed);
  std::partial_sort(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(named), names.end());
  std::string text;
  for (std::size_t i = 0; i < named; ++i) {
    text += (i > 0 ? ", " : "") + shown(names[i]);
  }
  if (names.size() > named) text += " and " + std::to_string(names.size() - named) + " more";
  return text.empty() ? "none" : text;
}

std::optional<std::vector<std::size_t>> TransformTree::linksAbove(std::size_t frame, std::string& reason) const {
  std::vector<std::size_t> links;
  for (std::size_t at = frame; link_above_[at]; at = links_[*link_above_[at]].parent) {
    links.push_back(*link_above_[at]);
    if (links.size() <= kLongestChain) continue;
    reason = "the parents of frame " + shown(frames_[frame]) + " form a cycle or a chain of more than " +
             std::to_string(kLongestChain) + " frames";
    for (std::size_t i = 0; i < 3; ++i)
      reason += (i == 0 ? ": " : ", ") + linkName(links_[links[links.size() - 1 - i]]);
    return std::nullopt;
  }
  return links;
}

std::vector<std::string> TransformTree::above(const std::string& frame) const {
  std::vector<std::string> names;
  const auto found = indices_.find(frameName(frame));
  if (found == indices_.end()) return names;
  std::string ignored;
  for (const std::size_t link : linksAbove(found->second, ignored).value_or(std::vector<std::size_t>()))
    names.push_back(frames_[links_[link].parent]);
  return names;
}

std::optional<TransformChain> TransformTree::chain(const std::string& target, const std::string& source,
                                                   std::string& reason) const {
  TransformChain chain;
  if (frameName(target) == frameName(source)) return chain;
  for (const std::string& frame : {target, source}) {
    if (has(frame)) continue;
    reason = "no transform has the frame " + shown(frameName(frame)) + "; the frames are " + frames();
    return std::nullopt;
  }
  std::optional<std::vector<std::size_t>> up = linksAbove(indices_.at(frameName(source)), reason), down;
  if (up) down = linksAbove(indices_.at(frameName(target)), reason);
  if (!up || !down) return std::nullopt;
  // The links that both frames have above them do not count.
  while (!up->empty() && !down->empty() && up->back() == down->back()) {
    up->pop_back();
    down->pop_back();
  }
  const std::size_t top_up = up->empty() ? indices_.at(frameName(source)) : links_[up->back()].parent;
  const std::size_t top_down = down->empty() ? indices_.at(frameName(target)) : links_[down->back()].parent;
  if (top_up != top_down) {
    reason = "the transforms do not connect " + shown(frameName(source)) + " (below " + shown(frames_[top_up]) +
             ") with " + shown(frameName(target)) + " (below " + shown(frames_[top_down]) + "); the frames are " +
             frames();
    return std::nullopt;
  }
  for (const std::size_t link : *down) chain.steps.push_back({link, true});
  for (auto link = up->rbegin(); link != up->rend(); ++link) chain.steps.push_back({*link, false});
  chain.moves = std::any_of(chain.steps.begin(), chain.steps.end(),
                            [this](const TransformChain::Step& step) { return !links_[step.link].poses.isConstant(); });
  return chain;
}

std::optional<Pose> TransformTree::pose(const TransformChain& chain, std::chrono::nanoseconds time,
                                        const PoseTimeLimits& limits, PoseLookup& lookup) const {
  Pose product;
  for (const TransformChain::Step& step : chain.steps) {
    const Link& link = links_[step.link];
    std::optional<Pose> one;
    if (link.poses.empty()) {
      one = link.fixed;
    } else if (link.poses.isConstant()) {
      one = link.poses.front();
    } else {
      one = link.poses.at(time, limits, lookup);
    }
    if (!one) {
      const bool is_before = time < link.poses.first();
      lookup.reason = "the transform " + linkName(link);
      if (lookup.is_outside)
        lookup.reason += std::string(is_before ? " starts at " : " ends at ") +
                         stampText(is_before ? link.poses.first() : link.poses.last());
      else
        lookup.reason += " has a gap there: the nearest is " + stampText(link.poses.distance(time)) + " s away";
      return std::nullopt;
    }
    product = product * (step.inverse ? one->inverse() : *one);
  }
  lookup.reason = poseFault(product);
  return lookup.reason.empty() ? std::optional(product) : std::nullopt;
}

std::optional<std::pair<std::chrono::nanoseconds, std::chrono::nanoseconds>> TransformTree::timesOf(
    const TransformChain& chain) const {
  std::optional<std::pair<std::chrono::nanoseconds, std::chrono::nanoseconds>> times;
  for (const TransformChain::Step& step : chain.steps) {
    const TimedPoses& poses = links_[step.link].poses;
    if (poses.empty() || poses.isConstant()) continue;
    if (!times) times = {poses.first(), poses.last()};
    times = {std::max(times->first, poses.first()), std::min(times->second, poses.last())};
  }
  return times;
}

void TransformTree::requireForwardTimes(const TransformChain& chain, std::chrono::nanoseconds limit) const {
  for (const TransformChain::Step& step : chain.steps)
    if (const Link& link = links_[step.link]; !link.poses.isConstant() && link.poses.stepBack() > limit)
      throw std::runtime_error("the times of the transform " + linkName(link) + " step back by " +
                               stampText(link.poses.stepBack()) + " s");
}

}  // namespace gaussmap::detail
