// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "common.h"
#include "evaluation/segment_score.h"
#include "evaluation/wall_score.h"

namespace gaussmap::app {

/// As printf() does it.
std::string rounded(const char* pattern, double value);

// One line on stdout each, or the same for machines. `scans`: that were scored.
void printScore(const detail::HoldOutScore& score, std::size_t scans);
Json scoreJson(const detail::HoldOutScore& score, std::size_t scans);
void printScore(const detail::WallScore& score);
Json scoreJson(const detail::WallScore& score);

}  // namespace gaussmap::app
