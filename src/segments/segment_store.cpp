// SPDX-License-Identifier: BSD-3-Clause
#include "segments/segment_store.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {

namespace {

constexpr double kMany = 2.0;  // a pruned segment has at least this many rays through it per ray that ends on it ...
constexpr double kMinRays = 10.0;  // ... and at least this many rays through it

}  // namespace

int SegmentStore::create() {
  int id = static_cast<int>(segments_.size());
  if (unused_.empty()) {
    segments_.emplace_back();
  } else {
    id = unused_.back();
    unused_.pop_back();
  }
  segments_[id].alive = true;
  return id;
}

void SegmentStore::remove(int id) {
  detach(id, segments_);
  index_.erase(id);
  segments_[id] = LiveSegment();
  unused_.push_back(id);
}

int SegmentStore::split(int id, std::size_t cut, bool linked) {
  const int next = segments_[id].next, previous = segments_[id].previous;
  detach(id, segments_);
  const LiveSegment whole = std::move(segments_[id]);
  const int other = create();
  segments_[id] = partOf(whole, 0, cut);
  segments_[other] = partOf(whole, cut, whole.evidence.row.cells().size());
  if (previous != kNone) link(previous, id, segments_);
  if (next != kNone) link(other, next, segments_);
  if (linked) link(id, other, segments_);
  enter(id);
  enter(other);
  return other;
}

void SegmentStore::merge(int into, int from) {
  int previous = segments_[into].previous, next = segments_[into].next;
  if (next == from || next == kNone) next = segments_[from].next;
  if (previous == from || previous == kNone) previous = segments_[from].previous;
  LiveSegment both = merged(segments_[into], segments_[from]);
  detach(into, segments_);
  remove(from);
  segments_[into] = std::move(both);
  if (next != kNone && next != into) link(into, next, segments_);
  if (previous != kNone && previous != into) link(previous, into, segments_);
  enter(into);
}

std::size_t SegmentStore::prune() {
  std::size_t pruned = 0;
  for (int id = 0; id < static_cast<int>(segments_.size()); ++id) {
    if (!segments_[id].alive) continue;
    double crossed = 0.0;
    for (const SegmentCell& cell : segments_[id].evidence.row.cells()) crossed += cell.crossed;
    if (crossed < kMinRays || crossed < kMany * segments_[id].spread.beams()) continue;
    remove(id);
    ++pruned;
  }
  return pruned;
}

Strip SegmentStore::polygon(const LiveSegment& segment) const {
  return {segment.start() - growth_ * segment.line.direction, segment.line.direction, segment.length() + 2.0 * growth_,
          std::max(min_half_width_, 3.0 * std::sqrt(segment.line.across))};
}

std::size_t SegmentStore::bytes() const {
  std::size_t sum = index_.bytes();
  for (const LiveSegment& segment : segments_) sum += sizeof(LiveSegment) + segment.evidence.bytes();
  return sum;
}

}  // namespace gaussmap::detail
