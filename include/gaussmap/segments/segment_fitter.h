// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"
#include "gaussmap/segments/sensor_model.h"
#include "gaussmap/segments/utility.h"
#include "gaussmap/version.h"

namespace gaussmap {
namespace detail {
struct SegmentFitterState;
}

/// How a segment stores its observations.
enum class EvidencePolicy {
  /// As weighted moments in small cells along the segment. This is like very many particles of which none is deleted.
  MomentCells,
  /// As a limited number of random particles, Leal 2000 sec. 4.4.
  ParticleSets
};

/// Which particles are deleted when a segment has too many.
enum class ParticleLimit {
  /// The limit holds for every stretch of 0.25 m of the segment. If a scan puts too many particles into a stretch,
  /// random particles of the stretch are deleted.
  Bins,
  /// The limit holds for the whole segment, as in the paper, sec. 4.4. Before an observation is added, random particles
  /// of the segment are deleted to make room for it. Parts that are seldom seen can thus lose their particles. After a
  /// merge, a segment can have more particles than the limit, until its next observation.
  Segment
};

/// Which segment an observation belongs to.
enum class SegmentAssociation {
  /// The nearest segment whose polygon contains the end of the beam. The sensor must also be on the free side of the
  /// segment, and the neighbouring beams must show a surface of about the same direction.
  Surface,
  /// The nearest segment whose polygon contains the mean of the samples of the observation, as in the paper, sec. 4.3.
  Polygon
};

/// Which segments can be merged with a segment.
enum class MergeCandidates {
  /// The linked neighbours, and other segments near the segment that have about the same direction.
  Near,
  /// Only the linked neighbours, as in the paper, eq. (4). They are candidates only if the linked ends are at most
  /// `gap` apart and the directions differ by less than 90 degrees.
  Linked
};

/// Options of EvidencePolicy::ParticleSets.
struct ParticleOptions {
  int samples = 30;  ///< M, particles per observation, >= 1
  /// Maximum number of particles per metre of a segment, > 0. With ParticleLimit::Segment, the length counts only up to
  /// 10 times SegmentFitterOptions::min_length. A stretch of 0.25 m (ParticleLimit::Bins) or a segment
  /// (ParticleLimit::Segment) can always have at least `samples` particles.
  double per_metre = 300.0;
  ParticleLimit limit = ParticleLimit::Bins;  ///< which particles are deleted
  std::uint64_t seed = 1;                     ///< same scans + same seed = same map
};

/// The tolerance and the costs with which SegmentFitter::map() chooses the segments. It maximises the number of
/// explained observations minus the cost of the segments.
///
/// The unit of a cost is a number of observations. Some costs are multiples of `average`: the mean number of
/// observations per cell with evidence. These costs grow with the evidence.
struct SegmentOptimisationOptions {
  double tolerance = 0.1;       ///< a segment explains only cells at most this far from its line (RMS) [m], > 0
  double segment_cost = 0.525;  ///< cost per segment [average], >= 0
  double cell_cost = 0.006;     ///< cost per cell along a segment [average], >= 0
  double hole_cost = 0.03;      ///< added per cell without evidence that is next to another such cell [average], >= 0
  double crossing_cost = 0.09;  ///< cost per ray that passed through the segment [observations], >= 0
  int rounds = 2;               ///< rounds of merging segments, filling gaps and removing segments, >= 0
};

/// Options of SegmentFitter.
struct GAUSSMAP_API SegmentFitterOptions {
  /// Returns the options of the paper, Leal 2000: 30 particles per observation, at most 300 per metre, a limit per
  /// segment, association by the polygon only, merges of linked segments only, no splits at holes, no change of the
  /// ends, no pruning, and no optimisation of the whole map.
  ///
  /// The utility is a separate parameter. The paper's utility is eq. (4):
  /// `SegmentFitter fitter(SegmentFitterOptions::leal2000(), std::make_shared<ViewpointInvariantUtility>());`
  ///
  /// The text of the paper leaves some steps open. For these, the preset does the same as the defaults:
  /// - The polygon of a segment is a rectangle, see min_half_width and growth. Of several segments whose polygons
  ///   contain an observation, the nearest gets it.
  /// - The noise of the laser is that of SensorNoise.
  /// - Neighbouring beams without a segment become one new segment. Before it is made, the utility can split it between
  ///   two beams; these votes use the ends of the beams, not the particles.
  /// - A segment is split between two cells (see `cell`), where the sum of the squared errors of both parts is
  ///   smallest. A cell with n observations counts n / (n + 1) in this sum. The utility votes on a segment again after
  ///   each scan that observed it. The number of votes per scan is limited.
  /// - The ends of a segment follow from the spread of the particles in its cells at both ends.
  /// - Segments are linked if neighbouring beams end on them and their ends are at most `gap` apart. If the lines of
  ///   linked segments meet near these ends, map() moves both ends to the intersection.
  /// - The number of particles of a segment has an upper bound: that of a segment of length 10 l_min.
  ///
  /// Nor does the paper give sigma_th of eq. (4), or alpha for l_min = 1 m. ViewpointInvariantOptions has values for
  /// both.
  static SegmentFitterOptions leal2000();

  EvidencePolicy policy = EvidencePolicy::MomentCells;  ///< how a segment stores its observations
  ParticleOptions particles;                            ///< options of EvidencePolicy::ParticleSets
  SensorNoise noise;                                    ///< noise of the laser
  double cell = 0.1;                                    ///< length of the cells along a segment [m], > 0
  /// l_min, used only for the limit of ParticleLimit::Segment [m], > 0. The l_min of the utility is a separate option,
  /// ViewpointInvariantOptions::min_length.
  double min_length = 1.0;
  /// Minimum half width of the polygon of a segment [m], > 0. The half width is 3 sigma_n if that is larger. Only
  /// observations in the polygon can be associated with the segment.
  double min_half_width = 0.1;
  double growth = 0.3;  ///< the polygon extends beyond both ends of the segment by this length [m], >= 0
  /// Adjacent beams belong together if their ends are less than this apart [m], > 0. Also used for links between
  /// segments, for merges and for holes.
  double gap = 0.5;
  SegmentAssociation association = SegmentAssociation::Surface;  ///< which segment an observation belongs to
  MergeCandidates merge_candidates = MergeCandidates::Near;      ///< which segments can be merged
  bool split_holes = true;  ///< splits a segment where it has no evidence for more than `gap`, without a vote
  /// map() fits the lines without the cells at their ends, and moves free ends to walls less than 15 cm away.
  bool adjust_ends = true;
  bool prune = true;     ///< deletes segments if many more rays cross them than end on them
  bool optimise = true;  ///< map() optimises all segments together, if SegmentUtility::optimisable() is true
  SegmentOptimisationOptions optimisation;  ///< options of this optimisation
};

/// What one call of SegmentFitter::add() or observe() did, and the state of the map after it. The curves of Leal 2000
/// Figs. 7 and 8 show such values.
struct SegmentStatistics {
  std::size_t beams = 0;         ///< number of beams with a return
  std::size_t associated = 0;    ///< number of beams that were associated with a segment of the map
  std::size_t created = 0;       ///< number of new segments
  std::size_t splits = 0;        ///< number of segments that a vote split; splits at holes do not count
  std::size_t merges = 0;        ///< number of merges of two segments
  std::size_t pruned = 0;        ///< number of segments deleted by SegmentFitterOptions::prune
  std::size_t segments = 0;      ///< number of segments of the map after the scan, before the optimisation of map()
  double normal_variance = 0.0;  ///< mean sigma_n^2 of all segments, weighted by observations [m^2]
  double coverage = 0.0;         ///< share of the scan's returns within 10 cm of a segment after the scan
};

/// Builds a map of linked line segments scan by scan, after Leal, Scheding, Dissanayake 2000.
///
/// Observations are associated with segments, and segments are fitted to their evidence. A utility decides whether a
/// segment is split, merged or left unchanged. The defaults differ from the paper because they give better maps:
/// - The evidence is kept as moments in cells, not as particles (see EvidencePolicy).
/// - A split or merge must shorten the description of the map (see DescriptionLengthUtility). In the paper, the
///   variance must pass a threshold, eq. (4).
/// - Segments that many rays cross are deleted (see SegmentFitterOptions::prune).
/// - map() optimises all segments together (see SegmentFitterOptions::optimise).
/// - Smaller differences: `association`, `merge_candidates`, `split_holes` and `adjust_ends` of the options.
///
/// For the method of the paper, use SegmentFitterOptions::leal2000() with a ViewpointInvariantUtility. The memory grows
/// with the map, not with the number of scans. The fitter uses one thread; the same scans and seed give the same map.
class GAUSSMAP_API SegmentFitter {
 public:
  /// Makes an empty map. Without a utility, DescriptionLengthUtility is used. Without an observation model, the options
  /// choose it: UnscentedObservations for moments, SampledObservations for particles, both with the noise of the
  /// options.
  ///
  /// A model of your own replaces the model of the options. SegmentFitterOptions::noise is then no longer used for the
  /// points of an observation, but still for the covariances of the segments and for SegmentAssociation::Surface.
  /// Throws std::invalid_argument if an option is out of range; the message gives the option and the rule.
  explicit SegmentFitter(const SegmentFitterOptions& options = {}, std::shared_ptr<SegmentUtility> utility = {},
                         std::shared_ptr<const ObservationModel> observation_model = {});
  ~SegmentFitter();
  SegmentFitter(SegmentFitter&&) noexcept;
  SegmentFitter& operator=(SegmentFitter&&) noexcept;

  /// Adds one scan to the map. Beams without a return are ignored, and the beams on both sides of them are not linked.
  ///
  /// Throws std::invalid_argument if the pose is not finite or its covariance is not positive semidefinite. Also throws
  /// it if the numbers of bearings and ranges differ, or the bearings are not finite and ascending. Also throws it if
  /// an observation model of your own returns points that are not finite, or weights that are negative or do not sum
  /// to 1. The scan is then not counted.
  SegmentStatistics add(const LaserScan& scan);

  /// Moves the observer to a position [m, map frame] without a scan, Leal 2000 Fig. 9 (b).
  ///
  /// The utility receives the position and votes again on the segments that SegmentUtility::reconsider() selects. With
  /// ViewpointDependentUtility, the map gets more detail near the position, and less where the observer was before. In
  /// the result, the members that describe a scan are 0. Throws std::invalid_argument if the position is not finite.
  SegmentStatistics observe(const Vector<2>& position);

  /// Returns a copy of the current map, optimised if SegmentFitterOptions::optimise is set.
  SegmentMap map() const;
  /// Returns the evidence of the segments [m, map frame]: their particles, or the means of their cells.
  std::vector<Vector<2>> evidence() const;
  /// Returns the number of scans added.
  std::size_t scans() const;
  /// Returns the options.
  const SegmentFitterOptions& options() const;
  /// Returns the approximate number of bytes in use.
  std::size_t memoryBytes() const;

 private:
  std::unique_ptr<detail::SegmentFitterState> state_;
};

}  // namespace gaussmap
