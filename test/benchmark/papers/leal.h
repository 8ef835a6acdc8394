// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "papers/report.h"
#include "papers_leal.h"

namespace gaussmap::papers {

/// The experiments of Leal 2000 on one recording.
struct LealResults {
  benchmark::LealData data;
  std::vector<benchmark::LealStudyRow> study;
  std::vector<benchmark::LealExampleRow> example;
  std::vector<benchmark::LealObserverRow> observer;
};

/// Runs the experiments; `seeds` of the particles.
LealResults runLeal(benchmark::LealData data, int seeds);

/// Adds the tables, plots and claims to the report.
void reportLeal(const std::vector<LealResults>& all, Report& report);

}  // namespace gaussmap::papers
