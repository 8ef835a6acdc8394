// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "common/json.h"
#include "evaluation/segment_score.h"
#include "evaluation/wall_score.h"

namespace gaussmap::app {

// One line on stdout each, or the same as JSON. `scans`: how many were scored.
void printScore(const detail::HoldOutScore& score, std::size_t scans);
Json scoreJson(const detail::HoldOutScore& score, std::size_t scans);
void printScore(const detail::WallScore& score);
Json scoreJson(const detail::WallScore& score);

}  // namespace gaussmap::app
