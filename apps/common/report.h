// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::app {

/// One line on stderr.
void warn(const std::string& text);

/// Seconds of a steady clock.
double now();
/// "12.35": seconds with two digits at most.
std::string secondsText(double seconds);
/// "12.3 MB".
std::string humanBytes(std::uintmax_t bytes);
/// A number in the format of printf().
std::string formatted(const char* pattern, double value);
/// Bytes that are not UTF-8, as in some file names, are replaced: XML and JSON must be UTF-8.
std::string validUtf8(const std::string& text);
/// A field of a CSV file, in quotes.
std::string csvQuoted(std::string text);

/// "526732 / 11327 / 129", finest first.
std::string perScale(const std::vector<std::size_t>& counts);
/// The Gaussians of a map in that way; with the map that it was made from: "1000 of 526732 / 20 of 11327".
std::string perScale(const GaussianMap<3>& map);
std::string perScale(const GaussianMap<3>& map, const GaussianMap<3>& whole);

/// Writes a text file whole or not at all. Throws FileError.
void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace gaussmap::app
