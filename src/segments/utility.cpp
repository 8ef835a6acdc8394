// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/utility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/check.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

void check(const ViewpointInvariantOptions& options) {
  require(std::isfinite(options.sigma_threshold) && options.sigma_threshold > 0.0, "sigma_threshold",
          options.sigma_threshold, "must be positive");
  require(std::isfinite(options.min_length) && options.min_length > 0.0, "min_length", options.min_length,
          "must be positive");
  require(options.merge_ratio >= 0.0 && options.merge_ratio < 1.0, "merge_ratio", options.merge_ratio,
          "must be at least 0 and below 1");
}

ViewpointInvariantOptions scaled(ViewpointInvariantOptions options, double scale) {
  options.min_length *= scale;
  return options;
}

}  // namespace

bool SegmentUtility::reconsider(const Vector<2>&, const Vector<2>&) const {
  return false;
}

ViewpointInvariantUtility::ViewpointInvariantUtility(const ViewpointInvariantOptions& options) : options_(options) {
  check(options);
}

double ViewpointInvariantUtility::split(const SegmentGoals& whole, const SegmentGoals&, const SegmentGoals&) const {
  const double threshold = options_.sigma_threshold * options_.sigma_threshold;
  return whole.normal_variance >= threshold && whole.length >= options_.min_length ? 1.0 : 0.0;
}

double ViewpointInvariantUtility::merge(const SegmentGoals&, const SegmentGoals&, const SegmentGoals& whole) const {
  const double threshold = options_.sigma_threshold * options_.sigma_threshold;
  return whole.normal_variance <= options_.merge_ratio * threshold ? 1.0 : 0.0;
}

ViewpointDependentUtility::ViewpointDependentUtility(const ViewpointDependentOptions& options)
    : options_(options),
      near_(scaled(options.far, options.scale)),
      far_(options.far),
      viewpoint_(options.viewpoint),
      before_(options.viewpoint) {
  require(std::isfinite(options.radius) && options.radius > 0.0, "radius", options.radius, "must be positive");
  require(options.scale > 0.0 && options.scale <= 1.0, "scale", options.scale, "must be above 0 and at most 1");
}

double ViewpointDependentUtility::split(const SegmentGoals& whole, const SegmentGoals& first,
                                        const SegmentGoals& second) const {
  return (inField(whole) ? near_ : far_).split(whole, first, second);
}

double ViewpointDependentUtility::merge(const SegmentGoals& first, const SegmentGoals& second,
                                        const SegmentGoals& whole) const {
  if (!inField(whole) && whole.length < options_.far.min_length) return 1.0;
  return far_.merge(first, second, whole);  // this vote does not depend on l_min
}

void ViewpointDependentUtility::observe(const Vector<2>& position) {
  before_ = viewpoint_;
  if (!options_.fixed) viewpoint_ = position;
}

bool ViewpointDependentUtility::reconsider(const Vector<2>& start, const Vector<2>& end) const {
  return inField(start, end, viewpoint_) != inField(start, end, before_);
}

bool ViewpointDependentUtility::inField(const Vector<2>& start, const Vector<2>& end,
                                        const Vector<2>& viewpoint) const {
  const Vector<2> along = end - start;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp(along.dot(viewpoint - start) / square, 0.0, 1.0) : 0.0;
  return (start + t * along - viewpoint).squaredNorm() <= options_.radius * options_.radius;
}

DescriptionLengthUtility::DescriptionLengthUtility(const DescriptionLengthOptions& options) : options_(options) {
  require(std::isfinite(options.sigma) && options.sigma > 0.0, "sigma", options.sigma, "must be positive");
  require(std::isfinite(options.segment_cost) && options.segment_cost >= 0.0, "segment_cost", options.segment_cost,
          "must not be negative");
}

double DescriptionLengthUtility::split(const SegmentGoals& whole, const SegmentGoals& first,
                                       const SegmentGoals& second) const {
  const double saved = whole.misfit - first.misfit - second.misfit;
  return saved / (2.0 * options_.sigma * options_.sigma) - options_.segment_cost;
}

double DescriptionLengthUtility::merge(const SegmentGoals& first, const SegmentGoals& second,
                                       const SegmentGoals& whole) const {
  return -split(whole, first, second);
}

double UserUtility::split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const {
  return split_vote ? split_vote(whole, first, second) : kNever;
}

double UserUtility::merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const {
  return merge_vote ? merge_vote(first, second, whole) : kNever;
}

double UserUtility::nothing(const SegmentGoals& segment) const {
  return nothing_vote ? nothing_vote(segment) : kNever;
}

CombinedUtility::CombinedUtility(std::vector<Part> parts) : parts_(std::move(parts)) {
  if (parts_.empty()) throw std::invalid_argument("combined utility: no parts");
  for (const Part& part : parts_) {
    if (!part.utility) throw std::invalid_argument("combined utility: a part without a utility");
    require(std::isfinite(part.weight), "weight of a utility", part.weight, "must be finite");
  }
}

double CombinedUtility::split(const SegmentGoals& whole, const SegmentGoals& first, const SegmentGoals& second) const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.weight * part.utility->split(whole, first, second);
  return sum;
}

double CombinedUtility::merge(const SegmentGoals& first, const SegmentGoals& second, const SegmentGoals& whole) const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.weight * part.utility->merge(first, second, whole);
  return sum;
}

double CombinedUtility::nothing(const SegmentGoals& segment) const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.weight * part.utility->nothing(segment);
  return sum;
}

void CombinedUtility::observe(const Vector<2>& position) {
  for (const Part& part : parts_) part.utility->observe(position);
}

bool CombinedUtility::reconsider(const Vector<2>& start, const Vector<2>& end) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.utility->reconsider(start, end); });
}

}  // namespace gaussmap
