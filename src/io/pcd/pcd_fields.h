// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/io/pcd/pcd_writer.h"

// Fields whose names may occur twice. PCL writes such files, and a program that copies a file must keep them.
namespace gaussmap::detail {

/// Works like checkPcdFields(), but names can occur twice.
void checkEachField(const std::vector<PcdOutput>& fields);

/// Works like writePcd() with fields, but names can occur twice.
void writeFields(const std::filesystem::path& path, std::size_t points, const std::vector<PcdOutput>& fields,
                 const std::optional<Pose>& viewpoint, std::size_t width);

}  // namespace gaussmap::detail
