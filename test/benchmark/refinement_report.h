// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "refinement_result.h"

namespace gaussmap::refinement {

/// Prints all figures of one data set as Markdown: means over the seeds, with the worst seed in brackets.
void printTable(const Table& table, const std::vector<Ratio>& ratios);

/// Prints the coarsest scales of all data sets in one table: 99 % / 95 % / mean over the seeds.
void printOverview(const std::vector<Table>& tables);

nlohmann::ordered_json toJson(const Table& table, const std::vector<Ratio>& ratios);

}  // namespace gaussmap::refinement
