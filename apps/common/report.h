// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::app {

/// Prints a warning as one line on stderr.
void warn(const std::string& text);
/// Prints as one line on stderr what a user may want to know, but what is not wrong.
void note(const std::string& text);

/// Time of a steady clock [s].
double now();
/// "12.35": seconds with at most two decimals.
std::string secondsText(double seconds);
/// "12.3 MB".
std::string humanBytes(std::uintmax_t bytes);
/// Formats a number with a pattern of printf().
std::string formatted(const char* pattern, double value);
/// Replaces bytes that are not UTF-8 (some file names contain them), because XML and JSON must be UTF-8.
std::string validUtf8(const std::string& text);
/// Returns a field of a CSV file in quotes.
std::string csvQuoted(std::string text);

/// "526732 / 11327 / 129", finest first.
std::string perScale(const std::vector<std::size_t>& counts);
/// The same for the Gaussians of a map. With `whole`, the map that it was made from: "1000 of 526732 / 20 of 11327".
template <int D>
std::string perScale(const GaussianMap<D>& map);
template <int D>
std::string perScale(const GaussianMap<D>& map, const GaussianMap<D>& whole);

/// Writes a text file atomically. Throws FileError if it cannot be written.
void writeText(const std::filesystem::path& path, const std::string& text);

/// Returns the name in a WKT, for example PROJCS "NAD83 / UTM zone 15N"; or the start of the text if it is not WKT.
std::string nameOfSystem(const std::string& text);

}  // namespace gaussmap::app
