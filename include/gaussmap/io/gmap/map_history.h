// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/editing/simplify.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/budget.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap {

// What the commands write beside a map, and `gaussmap info` shows. A refinement in C++:
//   const Budget budget = PerCell{4.0};
//   MapMetadata metadata = loadMetadata("in.gmap");
//   recordStep(metadata, refineStep(budget));
//   saveMap(refine(loadMap<3>("in.gmap"), budget), "out.gmap", metadata);

/// Metadata entry: a JSON array with one object per step, in the order in which they were done.
inline constexpr const char* kHistoryEntry = "history";
/// Metadata entry: JSON, [{"scale": s, "points": [{"gaussians": n, "q99": m, "q95": m, "mean": m}, ...]}, ...].
inline constexpr const char* kCurvesEntry = "error_curves";

/// The step of a refinement: method, budget, and what else differs from the defaults, as a JSON object. The members of
/// `details`, another JSON object such as {"command": "refine"}, are added and replace members of the same name. Throws
/// std::invalid_argument if `details` is not a JSON object.
std::string refineStep(const Budget& budget, const RefineOptions& options = {}, const std::string& details = "{}");
/// The same for simplify().
std::string simplifyStep(const Budget& budget, const SimplifyOptions& options = {}, const std::string& details = "{}");

/// Adds a step to the history. A history that is not a JSON array is replaced. Throws std::invalid_argument if `step`
/// is not a JSON object.
void recordStep(MapMetadata& metadata, const std::string& step);

/// Sets the error curves; removes old ones if there are none.
void recordCurves(MapMetadata& metadata, const std::vector<ErrorCurve>& curves);

/// saveMap() and savedSize() with the curves of the result in the metadata.
template <int D>
void saveMap(const RefineResult<D>& result, const std::filesystem::path& path, MapMetadata metadata = {},
             const SaveOptions& options = {});
template <int D>
std::uintmax_t savedSize(const RefineResult<D>& result, MapMetadata metadata = {}, const SaveOptions& options = {});

/// The budget of a map file of at most so many bytes, with curves and this metadata: measured by savedSize().
MaxBytes maxFileBytes(std::uintmax_t bytes, const MapMetadata& metadata = {}, const SaveOptions& options = {});

}  // namespace gaussmap
