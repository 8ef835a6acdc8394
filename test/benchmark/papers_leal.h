// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"

// The experiments of Leal, Scheding, Dissanayake 2000, sec. 4.2 and 5. All functions use one thread.
namespace gaussmap::benchmark {

/// How a map of segments is made.
enum class LealMethod {
  AsPrinted,  ///< SegmentFitterOptions::leal2000() with the utilities of the paper, eq. (4) and (5)
  Moments,    ///< evidence as moments, pruning, no optimisation, the utilities of the paper
  Default     ///< the defaults of the library: moments, description length, pruning, optimisation; l_min has no effect
};
/// Returns "as printed", "moments, eq. (4)" or "default".
std::string nameOf(LealMethod method);

/// The scans of an experiment.
struct LealData {
  std::string name;  ///< "simulated plan", "rough hall" or "Intel lab"
  std::vector<LaserScan> scans;
  std::vector<LaserScan> test;  ///< scans that are not in the maps; of simulated places, without noise
  std::vector<Segment> walls;   ///< the true walls; empty if they are not known
  Box<2> window;                ///< a part of the place, 7 m x 8 m, for the example of Figs. 4 and 5 [m]
  std::vector<Vector<2>> path;  ///< positions of the observer of Fig. 9 (b) [m]
};
/// Returns scans of the simulated floor plan (ranges +- 2 cm, exact poses): straight walls. `seed`: of the noise.
LealData simulatedPlan(std::uint64_t seed = 1);
/// Returns scans of a hall of 44 m x 24 m with rough walls (ranges +- 2 cm, exact poses), like the unstructured place
/// of the paper. The walls have bumps of up to 23 cm, 1 m to 4 m long.
LealData roughHall(std::uint64_t seed = 1);
/// Returns the scans of a CARMEN log in a directory, for example carmen_intel. The even scans make the maps, and the
/// odd ones test them. Throws FileError if there is no log.
LealData logOf(const std::filesystem::path& folder, const std::string& name);

/// What a map is like. Means over the seeds of the particles. NaN: not known. With test scans without noise, `rms` is
/// the error of the map: of its distances from the true walls, up to 20 cm.
struct LealMeasure {
  double segments = 0.0, splits = 0.0, merges = 0.0;  ///< numbers; splits and merges over all scans
  double normal_variance = 0.0;                       ///< sigma_n^2, mean over the observations [m^2]
  double length = 0.0;                                ///< total length of the segments [m]
  // Scans that are not in the map, see HoldOutScore.
  double within_5cm = 0.0, within_10cm = 0.0, rms = 0.0, predicted_10cm = 0.0, blocked_early = 0.0;
  // True walls within 5 cm, see WallScore: shares, [m], [rad]. NaN without walls, or if all walls are too short.
  double recall = std::numeric_limits<double>::quiet_NaN(), precision = recall, offset_rms = recall, angle_rms = recall;
  /// Length of the true walls [m]; a longer map is a zigzag that follows the noise. NaN without walls.
  double true_length = recall;
};

/// Figs. 7 and 8: the effect of l_min.
struct LealStudyRow {
  LealMethod method = LealMethod::AsPrinted;
  double min_length = 0.0;  ///< l_min [m]; NaN for LealMethod::Default
  LealMeasure map;
  double sigma_threshold = 0.0;  ///< sigma_th [m]; NaN for LealMethod::Default
};
/// Returns the rows of AsPrinted and Moments for sigma_th = 6 cm (the default of the library) and 2.8 cm (the noise of
/// the particles of simulated scans), each for l_min = 0.3, 0.5, 0.7, 1, 1.25, 1.5, 2, 2.5, 3 m, then one row of
/// Default. The paper does not give sigma_th. `seeds`: runs of AsPrinted with different particles.
std::vector<LealStudyRow> lealStudy(const LealData& data, int seeds);

/// Sec. 5: "30 samples, at most 300 particles per metre".
struct LealParticleRow {
  int samples = 30;          ///< M
  double per_metre = 300.0;  ///< maximum number of particles per metre
  bool in_bins = false;      ///< false: the limit of the paper, per segment; true: per 0.25 m of the segment
  LealMeasure map;
};
/// Returns AsPrinted (l_min 1 m, sigma_th 6 cm) with other numbers of particles: M = 3, 10, 30, 100 with 300 per metre,
/// then 100, 1000 and 3000 per metre with M = 30, then 300 per metre with a limit per bin.
std::vector<LealParticleRow> lealParticles(const LealData& data, int seeds);

/// Figs. 4 and 5: a part of 7 m x 8 m, l_min = 1.5 m, a = 0.53, viewpoint-invariant and viewpoint-dependent.
struct LealExampleRow {
  LealMethod method = LealMethod::AsPrinted;
  bool dependent = false;           ///< eq. (5), the observer is at the middle of the window; false: eq. (4)
  double segments = 0.0;            ///< number of segments whose middle is in the window
  double length = 0.0;              ///< their total length [m]
  double normal_variance = 0.0;     ///< mean sigma_n^2 of these segments, by length [m^2]
  SegmentMap map;                   ///< of the whole place
  std::vector<Vector<2>> evidence;  ///< of the whole place [m]
  double sigma_threshold = 0.0;     ///< sigma_th [m]; NaN for LealMethod::Default
};
/// Returns four rows each for AsPrinted and Moments (both values of sigma_th, both utilities), and one for Default.
std::vector<LealExampleRow> lealExample(const LealData& data);

/// Fig. 9: l_min = 3 m, a = 0.33. After the scans, an observer walks through the finished map. The segments within 5 m
/// of each position of the path are counted: without an observer in the map, while the observer is there, and when it
/// is at least 15 m away.
struct LealObserverRow {
  LealMethod method = LealMethod::AsPrinted;  ///< AsPrinted or Moments
  std::size_t places = 0;                     ///< positions of the path
  std::size_t left = 0;                       ///< positions from which the observer got 15 m away
  /// Mean number of segments near a place, their number per metre, and their mean normal variance [m^2].
  struct Detail {
    double segments = 0.0, per_metre = 0.0, normal_variance = 0.0;
  };
  Detail before;     ///< no observer, all places
  Detail there;      ///< the observer is at the place, all places
  Detail after;      ///< the observer has left the place, places that were left only
  Detail unvisited;  ///< no observer, the places that were left only; to compare with `after`
  /// Mean number of segments outside the field: without an observer, and with the observer at the places of the path.
  double elsewhere_before = 0.0, elsewhere = 0.0;
  /// Segments of the whole map: of eq. (4), of eq. (5) before an observer was in the map, and after it left.
  double total_invariant = 0.0, total_before = 0.0, total_after = 0.0;
  double sigma_threshold = 0.0;  ///< sigma_th [m]
};
/// Returns two rows each for AsPrinted and Moments, for both values of sigma_th.
std::vector<LealObserverRow> lealObserver(const LealData& data);

/// Prints the tables of these experiments in Markdown.
void printLeal(const LealData& data, int seeds);

}  // namespace gaussmap::benchmark
