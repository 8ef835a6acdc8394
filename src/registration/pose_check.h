// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"
#include "registration/pose_pairs.h"

namespace gaussmap::detail {

struct PoseCheckOptions {
  PoseConvention convention = PoseConvention::SensorToMap;  ///< of the poses, as the program assumes
  std::optional<ReadPoses> read;  ///< the poses before they were converted; nullopt: those of the scans
  std::optional<PoseConvention> never = std::nullopt;  ///< a convention that the poses cannot have
  std::size_t pairs = 4;                               ///< pairs of scans to compare; more if the scans have few points
  std::size_t points_per_scan = 8192;                  ///< most points of a scan that are used
  int threads = 0;                                     ///< 0 = all cores
};

/// How two conventions compare: counts the flat pieces of scans for which they predict different places.
struct ConventionDuel {
  std::size_t pieces = 0;      ///< all such pieces
  std::size_t first_only = 0;  ///< that lie on a surface of the other scan only with the first convention
  std::size_t other_only = 0;  ///< that lie on a surface of the other scan only with the other convention
  std::size_t both = 0;        ///< that lie on a surface with both

  /// Adds the counts of other pieces.
  ConventionDuel& operator+=(const ConventionDuel& more);
};

/// How well the pieces of scans lie on the scans that they are compared with.
struct ConventionFit {
  std::size_t met = 0;  ///< pieces at places where the other scan has a surface, on it or beside it
  std::size_t on = 0;   ///< of these, pieces that lie on the surface

  /// Returns the share of pieces that lie on the surface.
  double share() const { return met > 0 ? double(on) / double(met) : 0.0; }
};

/// The result of checkPoses().
struct PoseCheck {
  PoseConvention given = PoseConvention::SensorToMap;  ///< what the program assumes
  std::optional<PoseConvention> better;                ///< a convention with which the scans fit clearly better
  ConventionDuel duel;                                 ///< with `better`: it (other) against the given one (first)
  bool doubtful = false;                               ///< the scans fit neither as given nor with another convention
  std::size_t pairs = 0;                               ///< pairs of scans that were compared
  std::vector<ConventionFit> fits;                     ///< per convention, in the order of kPoseConventions
  /// duels[a][b]: convention a (first) against b (other), in the order of kPoseConventions.
  std::vector<std::vector<ConventionDuel>> duels;
};

/// Checks whether the scans fit each other better if their poses mean something else.
///
/// Compares a few pairs of neighbouring scans. For each flat piece of a scan, it tests if the other scan has a surface
/// there, for the given poses and for each other convention. Only pieces for which two conventions predict different
/// places count: the ground says nothing about a motion along it. Another convention is better if it puts many more
/// pieces onto surfaces, in most of the pairs, and if most of all pieces then lie on surfaces. Throws like
/// Scans::open() and ScanReader::read().
GAUSSMAP_API PoseCheck checkPoses(const Scans& scans, const PoseCheckOptions& options = {});

}  // namespace gaussmap::detail
