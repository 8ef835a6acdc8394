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

/// What a segment remembers of its observations.
enum class EvidencePolicy {
  MomentCells,  ///< weighted moments in small cells along it: infinitely many particles, nothing forgotten
  ParticleSets  ///< a limited number of random particles, Leal 2000 sec. 4.4
};

/// Which particles are forgotten when there are too many.
enum class ParticleLimit {
  Bins,    ///< random ones of each stretch of 0.25 m that has too many
  Segment  ///< random ones of the whole segment, as in the paper: parts that are seen often displace the others
};

/// Options of EvidencePolicy::ParticleSets.
struct ParticleOptions {
  int samples = 30;          ///< M, particles per observation, >= 1
  double per_metre = 300.0;  ///< limit per metre of a segment, of at most 10 SegmentFitterOptions::min_length, > 0
  ParticleLimit limit = ParticleLimit::Bins;
  std::uint64_t seed = 1;
};

/// How SegmentFitter::map() chooses the segments that explain the most evidence for what they cost. Costs are in
/// observations. `average` is the mean number of observations per cell that has any, so costs grow with the evidence.
struct SegmentOptimisationOptions {
  double tolerance = 0.1;       ///< a segment explains nothing that is farther from its line [m], > 0
  double segment_cost = 0.525;  ///< per segment [average], >= 0
  double cell_cost = 0.006;     ///< per cell of its length [average], >= 0
  double hole_cost = 0.03;      ///< in addition, per cell without evidence [average], >= 0
  double crossing_cost = 0.09;  ///< per ray that passed through it [observations], >= 0
  int rounds = 2;               ///< of merging, filling and removing, >= 0
};

struct GAUSSMAP_API SegmentFitterOptions {
  /// Leal 2000 as printed: particles, with a limit per segment; no pruning, no optimisation of the whole map. The
  /// utility is a parameter of its own; the paper's is eq. [4]:
  ///   SegmentFitter fitter(SegmentFitterOptions::leal2000(), std::make_shared<ViewpointInvariantUtility>());
  static SegmentFitterOptions leal2000();

  EvidencePolicy policy = EvidencePolicy::MomentCells;
  ParticleOptions particles;  ///< of EvidencePolicy::ParticleSets
  SensorNoise noise;
  double cell = 0.1;            ///< length of the cells along a segment [m], > 0
  double min_length = 1.0;      ///< l_min, bounds the particles of a segment [m], > 0
  double min_half_width = 0.1;  ///< least half width of the polygon that takes observations [m], > 0
  double growth = 0.3;          ///< by which the polygon is longer than its segment at both ends [m], >= 0
  double gap = 0.5;             ///< neighbouring beams farther apart are not linked [m], > 0
  bool prune = true;            ///< delete segments that many more rays cross than end on
  bool optimise = true;         ///< map(): decide on all segments together, if the utility is optimisable()
  SegmentOptimisationOptions optimisation;
};

/// What one add() did, and the map after it: the curves of Leal 2000 Figs. 7 and 8.
struct SegmentStatistics {
  std::size_t beams = 0;       ///< that returned
  std::size_t associated = 0;  ///< of them, those that belong to a segment of the map
  std::size_t created = 0;     ///< new segments
  std::size_t splits = 0;
  std::size_t merges = 0;
  std::size_t pruned = 0;
  std::size_t segments = 0;      ///< of the map after the scan
  double normal_variance = 0.0;  ///< mean of sigma_n^2 over all observations of the map [m^2]
  double coverage = 0.0;         ///< share of the scan's beams that end within 10 cm of the map after it
};

/// Builds a map of linked line segments scan by scan, after Leal, Scheding, Dissanayake 2000: observations are
/// associated with segments, segments are fitted to their evidence, and utilities decide whether they are split, merged
/// or left alone. Four defaults are not those of the paper, because they give better maps:
/// - the evidence is kept as moments in cells, not as particles (EvidencePolicy);
/// - a split or merge must shorten the description of the map (DescriptionLengthUtility), not pass a threshold, eq.
/// [4];
/// - segments that many rays cross are deleted (SegmentFitterOptions::prune);
/// - map() optimises all segments together (SegmentFitterOptions::optimise).
/// SegmentFitterOptions::leal2000() with a ViewpointInvariantUtility is the paper as printed.
/// Memory grows with the map, not with the scans. One thread; the same scans and seed give the same map.
class GAUSSMAP_API SegmentFitter {
 public:
  /// Without a utility: DescriptionLengthUtility. Throws std::invalid_argument, naming the option and what is required.
  explicit SegmentFitter(const SegmentFitterOptions& options = {}, std::shared_ptr<SegmentUtility> utility = {});
  ~SegmentFitter();
  SegmentFitter(SegmentFitter&&) noexcept;
  SegmentFitter& operator=(SegmentFitter&&) noexcept;

  /// One scan. Beams without return are left out; neighbours across them are not linked. Throws
  /// std::invalid_argument if the pose is not finite, its covariance is not positive semidefinite, or bearings are not
  /// as many as ranges or not finite; the scan is then not counted.
  SegmentStatistics add(const LaserScan& scan);

  /// The map as it is now, optimised or as add() left it (SegmentFitterOptions::optimise).
  SegmentMap map() const;
  /// What the map's segments remember: their particles, or means of their cells [m], map frame.
  std::vector<Vector<2>> evidence() const;
  std::size_t scans() const;
  const SegmentFitterOptions& options() const;
  /// Bytes held, about.
  std::size_t memoryBytes() const;

 private:
  std::unique_ptr<detail::SegmentFitterState> state_;
};

}  // namespace gaussmap
