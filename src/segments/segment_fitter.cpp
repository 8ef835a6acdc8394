// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/segment_fitter.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "segments/fitter_state.h"
#include "segments/output_map.h"
#include "segments/refine.h"

namespace gaussmap {
using namespace detail;

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
  positive(options.particles.longest, "particles.longest");
  positive(options.particles.bin, "particles.bin");
  const SegmentRefinementOptions& refinement = options.refinement;
  positive(refinement.tolerance, "refinement.tolerance");
  require(refinement.segment_cost >= 0.0, "refinement.segment_cost", refinement.segment_cost, "must not be negative");
  require(refinement.cell_cost >= 0.0, "refinement.cell_cost", refinement.cell_cost, "must not be negative");
  require(refinement.hole_cost >= 0.0, "refinement.hole_cost", refinement.hole_cost, "must not be negative");
  require(refinement.crossing_cost >= 0.0, "refinement.crossing_cost", refinement.crossing_cost,
          "must not be negative");
  require(refinement.rounds >= 0, "refinement.rounds", refinement.rounds, "must not be negative");
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

SegmentFitter::SegmentFitter(const SegmentFitterOptions& options, std::shared_ptr<SegmentUtility> utility)
    : state_(std::make_unique<SegmentFitterState>()) {
  check(options);
  state_->options = options;
  state_->utility = utility ? std::move(utility) : std::make_shared<DescriptionLengthUtility>();
  if (options.policy == EvidencePolicy::ParticleSets)
    state_->model =
        std::make_unique<SampledObservations>(options.noise, options.particles.samples, options.particles.seed);
  else
    state_->model = std::make_unique<UnscentedObservations>(options.noise);
  state_->keeper = makeEvidenceKeeper(options);
}

SegmentFitter::~SegmentFitter() = default;
SegmentFitter::SegmentFitter(SegmentFitter&&) noexcept = default;
SegmentFitter& SegmentFitter::operator=(SegmentFitter&&) noexcept = default;

SegmentStatistics SegmentFitter::add(const LaserScan& scan) {
  check(scan);
  return state_->add(scan);
}

SegmentMap SegmentFitter::map() const {
  const bool refined = state_->options.refine && state_->utility->refinable();
  return outputMap(refined ? refineSegments(*state_) : state_->segments, state_->origin);
}

std::vector<Vector<2>> SegmentFitter::evidence() const {
  std::vector<Vector<2>> points;
  for (const LiveSegment& segment : state_->segments) {
    for (const Particle& particle : segment.evidence.particles)
      points.push_back(state_->origin + particle.cast<double>());
    if (!segment.evidence.particles.empty()) continue;
    for (const SegmentCell& cell : segment.evidence.row.cells())
      if (cell.hits.n > 0.0) points.push_back(state_->origin + cell.hits.mean());
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
  std::size_t sum = sizeof(SegmentFitterState) + state_->index.bytes() + state_->views.bytes();
  for (const LiveSegment& segment : state_->segments) sum += sizeof(LiveSegment) + segment.evidence.bytes();
  return sum;
}

}  // namespace gaussmap
