// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "papers/report.h"
#include "papers_leal.h"

namespace gaussmap::papers {

/// The experiments of Leal 2000 on one recording.
struct LealResults {
  benchmark::LealData data;
  double sigma_threshold = 0.06;  ///< sigma_th near the noise of the particles, by which the claims are judged [m]
  std::vector<benchmark::LealStudyRow> study;
  std::vector<benchmark::LealParticleRow> particles;
  std::vector<benchmark::LealExampleRow> example;
  std::vector<benchmark::LealObserverRow> observer;
};

/// Runs the experiments; `seeds` of the particles. `sigma_threshold`: 0.028 or 0.06, see LealResults.
LealResults runLeal(benchmark::LealData data, double sigma_threshold, int seeds);

/// Adds the tables, plots and claims to the report.
void reportLeal(const std::vector<LealResults>& all, Report& report);

}  // namespace gaussmap::papers
