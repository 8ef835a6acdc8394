// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::detail {

/// Writes records like saveRecordsPcd(), but with x y z as doubles in the map frame, so that nothing is lost far from
/// the origin. The VIEWPOINT is the identity.
void saveWideRecordsPcd(const std::filesystem::path& path, const GaussianRecords& records);

}  // namespace gaussmap::detail
