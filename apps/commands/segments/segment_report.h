// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "common/json.h"
#include "evaluation/segment_score.h"
#include "evaluation/wall_score.h"

namespace gaussmap::app {

// printScore() prints one line on stdout; scoreJson() returns the same values as JSON. `scans` is the number of scored
// scans.
void printScore(const detail::HoldOutScore& score, std::size_t scans);
Json scoreJson(const detail::HoldOutScore& score, std::size_t scans);
void printScore(const detail::WallScore& score);
Json scoreJson(const detail::WallScore& score);

}  // namespace gaussmap::app
