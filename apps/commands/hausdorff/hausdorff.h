// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands/any_map.h"
#include "commands/planar_input.h"
#include "commands/scan_input.h"
#include "common/json.h"
#include "common/usage.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/evaluation/held_out.h"

namespace gaussmap::app {

enum class ReferenceKind { Cloud, Mesh, Map };

struct HausdorffCommand {
  std::string subject;
  ScanInput reference;
  std::optional<int> scale;
  bool leaves = false;
  SampleOptions samples;
  bool max_only = false;
  bool held_out = false;
  bool check = false;
  HeldOutOptions scoring;
  Output errors;
  std::string direction = "forward";
  Slice slice;  // of 3-D scans, for a planar map
  bool json = false;

  std::string onlyReference() const { return reference.paths.size() == 1 ? reference.paths.front() : std::string(); }
};

// The four jobs of the command. Each function prints its result. D: dimensions of the map.
template <int D>
void compareMap(const HausdorffCommand& command, ReferenceKind reference);
void compareCloud(const HausdorffCommand& command, ReferenceKind reference);
void compareMaxima(const HausdorffCommand& command);
template <int D>
void scoreMap(const HausdorffCommand& command);

/// A scale, or std::nullopt for all leaves of the map.
using Level = std::optional<int>;
std::string textOf(const Level& level);
Json jsonOf(const Level& level);
/// Returns the levels to compare: the level that the user chose, or else every scale that all maps have. If a map is
/// compressed, the leaves come first, and scales without cells in some map are left out. Throws UsageError if a map
/// does not have the chosen scale.
template <int D>
std::vector<Level> chosenLevels(const HausdorffCommand& command, const std::vector<const GaussianMap<D>*>& maps);

/// Reads the reference points for a map of D dimensions [m, map frame]. Throws UsageError for --slice if D = 3.
template <int D>
std::vector<Vector<D>> readReference(const HausdorffCommand& command, double resolution);

}  // namespace gaussmap::app
