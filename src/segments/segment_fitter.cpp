// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/segment_fitter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/check.h"
#include "segments/fitter_state.h"
#include "segments/optimise.h"
#include "segments/output_map.h"

namespace gaussmap {
using namespace detail;

namespace {

void check(const SegmentFitterOptions& options) {
  const auto positive = [](double value, const char* name) {
    require(std::isfinite(value) && value > 0.0, name, value, "must be positive");
  };
  positive(options.cell, "cell");
  positive(options.min_length, "min_length");
  positive(options.min_half_width, "min_half_width");
  positive(options.gap, "gap");
  require(std::isfinite(options.growth) && options.growth >= 0.0, "growth", options.growth, "must not be negative");
  positive(options.particles.per_metre, "particles.per_metre");
  const SegmentOptimisationOptions& costs = options.optimisation;
  positive(costs.tolerance, "optimisation.tolerance");
  require(costs.segment_cost >= 0.0, "optimisation.segment_cost", costs.segment_cost, "must not be negative");
  require(costs.cell_cost >= 0.0, "optimisation.cell_cost", costs.cell_cost, "must not be negative");
  require(costs.hole_cost >= 0.0, "optimisation.hole_cost", costs.hole_cost, "must not be negative");
  require(costs.crossing_cost >= 0.0, "optimisation.crossing_cost", costs.crossing_cost, "must not be negative");
  require(costs.rounds >= 0, "optimisation.rounds", costs.rounds, "must not be negative");
  require(options.particles.samples >= 1, "particles.samples", options.particles.samples, "must be at least 1");
}

void check(const LaserScan& scan) {
  const auto fail = [](const std::string& what) { throw std::invalid_argument("laser scan: " + what); };
  if (scan.bearings.size() != scan.ranges.size())
    fail(std::to_string(scan.bearings.size()) + " bearings for " + std::to_string(scan.ranges.size()) + " ranges");
  if (!scan.pose.translation.allFinite() || !std::isfinite(scan.pose.heading)) fail("the pose is not finite");
  if (!scan.pose.covariance.allFinite()) fail("the covariance of the pose is not finite");
  for (std::size_t i = 0; i < scan.bearings.size(); ++i) {
    if (!std::isfinite(scan.bearings[i])) fail("bearing " + std::to_string(i) + " is not finite");
    if (i > 0 && scan.bearings[i] < scan.bearings[i - 1]) fail("bearing " + std::to_string(i) + " is not ascending");
  }
  if (scan.pose.covariance.isZero(0.0)) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scan.pose.covariance, Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()(0) < -1e-9 * std::abs(solver.eigenvalues()(2)))
    fail("the covariance of the pose is not positive semidefinite");
}

}  // namespace

SegmentFitterOptions SegmentFitterOptions::leal2000() {
  SegmentFitterOptions options;
  options.policy = EvidencePolicy::ParticleSets;
  options.particles.samples = 30;
  options.particles.per_metre = 300.0;
  options.particles.limit = ParticleLimit::Segment;
  options.min_length = 1.0;
  options.association = SegmentAssociation::Polygon;
  options.merge_candidates = MergeCandidates::Linked;
  options.split_holes = false;
  options.adjust_ends = false;
  options.prune = false;
  options.optimise = false;
  return options;
}

SegmentFitter::SegmentFitter(const SegmentFitterOptions& options, std::shared_ptr<SegmentUtility> utility,
                             std::shared_ptr<const ObservationModel> observation_model) {
  check(options);
  if (!utility) utility = std::make_shared<DescriptionLengthUtility>();
  state_ = std::make_unique<SegmentFitterState>(options, std::move(utility), std::move(observation_model));
}

SegmentFitter::~SegmentFitter() = default;
SegmentFitter::SegmentFitter(SegmentFitter&&) noexcept = default;
SegmentFitter& SegmentFitter::operator=(SegmentFitter&&) noexcept = default;

SegmentStatistics SegmentFitter::add(const LaserScan& scan) {
  check(scan);
  return state_->add(scan);
}

SegmentStatistics SegmentFitter::observe(const Vector<2>& position) {
  if (!position.allFinite()) throw std::invalid_argument("position of the observer: not finite");
  return state_->observe(position);
}

SegmentMap SegmentFitter::map() const {
  const std::deque<LiveSegment>& segments = state_->store.segments();
  const bool optimised = state_->options.optimise && state_->votes.utility().optimisable();
  return outputMap(optimised ? optimiseSegments(segments, state_->views, state_->options) : segments,
                   state_->votes.origin(), state_->options.adjust_ends);
}

std::vector<Vector<2>> SegmentFitter::evidence() const {
  const Vector<2>& origin = state_->votes.origin();
  std::vector<Vector<2>> points;
  for (const LiveSegment& segment : state_->store.segments()) {
    for (const Particle& particle : segment.evidence.particles) points.push_back(origin + particle.cast<double>());
    if (!segment.evidence.particles.empty()) continue;
    for (const SegmentCell& cell : segment.evidence.row.cells())
      if (cell.hits.n > 0.0) points.push_back(origin + cell.hits.mean());
  }
  return points;
}

std::size_t SegmentFitter::scans() const {
  return static_cast<std::size_t>(state_->scans);
}

const SegmentFitterOptions& SegmentFitter::options() const {
  return state_->options;
}

std::size_t SegmentFitter::memoryBytes() const {
  return sizeof(SegmentFitterState) + state_->store.bytes() + state_->views.bytes();
}

}  // namespace gaussmap
