// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "common.h"
#include "gaussmap/evaluation/segment_score.h"
#include "gaussmap/evaluation/wall_score.h"

namespace gaussmap::app {

/// As printf() does it.
std::string rounded(const char* pattern, double value);

// One line on stdout each, or the same for machines. `scans`: that were scored.
void print(const HoldOutScore& score, std::size_t scans);
Json jsonOf(const HoldOutScore& score, std::size_t scans);
void print(const WallScore& score);
Json jsonOf(const WallScore& score);

}  // namespace gaussmap::app
