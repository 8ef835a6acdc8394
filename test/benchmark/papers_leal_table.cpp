// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include "papers_leal.h"

namespace gaussmap::benchmark {
namespace {

double centimetres(double variance) {
  return 100.0 * std::sqrt(variance);
}

std::string thresholdText(double threshold) {
  if (std::isnan(threshold)) return "-";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 100.0 * threshold);
  return text;
}

std::string trueLengthText(const LealMeasure& map) {
  if (std::isnan(map.true_length)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", map.true_length);
  return text;
}

void printStudy(const LealData& data, int seeds) {
  std::printf(
      "| %s, Figs. 7 and 8 | sigma_th [cm] | l_min [m] | normal deviation [cm] | segments | splits | merges | "
      "length (true) [m] | cov5 | cov10 | rms [cm] | r10 | viol | recall | precision | offset [mm] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      data.name.c_str());
  for (const LealStudyRow& row : lealStudy(data, seeds)) {
    const LealMeasure& map = row.map;
    std::printf("| %s | ", nameOf(row.method).c_str());
    std::printf(std::isnan(row.min_length) ? "%s | -" : "%s | %.2f", thresholdText(row.sigma_threshold).c_str(),
                row.min_length);
    std::printf(" | %.2f | %.0f | %.0f | %.0f | %.1f (%s) | %.3f | %.3f | %.2f | %.3f | %.3f | ",
                centimetres(map.normal_variance), map.segments, map.splits, map.merges, map.length,
                trueLengthText(map).c_str(), map.within_5cm, map.within_10cm, 100.0 * map.rms, map.predicted_10cm,
                map.blocked_early);
    for (const double value : {map.recall, map.precision, 1000.0 * map.offset_rms})
      std::printf(std::isnan(value) ? "- | " : "%.3f | ", value);
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("\n");
}

void printParticles(const LealData& data, int seeds) {
  std::printf(
      "| %s, sec. 5: l_min 1 m, M | per metre | limit | segments | length (true) [m] | cov5 | cov10 | rms [cm] | r10 | "
      "viol | recall |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n",
      data.name.c_str());
  for (const LealParticleRow& row : lealParticles(data, seeds)) {
    const LealMeasure& map = row.map;
    std::printf("| %d | %.0f | %s | %.0f | %.1f (%s) | %.3f | %.3f | %.2f | %.3f | %.3f | ", row.samples, row.per_metre,
                row.in_bins ? "bins" : "segment", map.segments, map.length, trueLengthText(map).c_str(), map.within_5cm,
                map.within_10cm, 100.0 * map.rms, map.predicted_10cm, map.blocked_early);
    std::printf(std::isnan(map.recall) ? "- |\n" : "%.3f |\n", map.recall);
    std::fflush(stdout);
  }
  std::printf("\n");
}

void printExample(const LealData& data) {
  std::printf(
      "| %s, Figs. 4 and 5: l_min 1.5 m, a .53, 7 m x 8 m | sigma_th [cm] | utility | segments | length [m] | normal "
      "deviation [cm] |\n"
      "|---|---|---|---|---|---|\n",
      data.name.c_str());
  for (const LealExampleRow& row : lealExample(data))
    std::printf("| %s | %s | %s | %.0f | %.1f | %.2f |\n", nameOf(row.method).c_str(),
                thresholdText(row.sigma_threshold).c_str(),
                row.method == LealMethod::Default ? "description-length"
                : row.dependent                   ? "viewpoint-dependent"
                                                  : "viewpoint-invariant",
                row.segments, row.length, centimetres(row.normal_variance));
  std::printf("\n");
}

void printObserver(const LealData& data) {
  std::printf(
      "| %s, Fig. 9: l_min 3 m, a .33; segments within 5 m of a place | without observer | observer there | observer "
      "15 m away | the same places without observer | elsewhere without / with observer | all: eq. (4) / before / "
      "after |\n"
      "|---|---|---|---|---|---|---|\n",
      data.name.c_str());
  const auto cell = [](const LealObserverRow::Detail& detail) {
    std::printf(" %.1f, %.2f per m, %.2f cm |", detail.segments, detail.per_metre, centimetres(detail.normal_variance));
  };
  for (const LealObserverRow& row : lealObserver(data)) {
    std::printf("| %s, sigma_th %s cm, %zu places, %zu left |", nameOf(row.method).c_str(),
                thresholdText(row.sigma_threshold).c_str(), row.places, row.left);
    for (const LealObserverRow::Detail& detail : {row.before, row.there, row.after, row.unvisited}) cell(detail);
    std::printf(" %.1f / %.1f | %.0f / %.0f / %.0f |\n", row.elsewhere_before, row.elsewhere, row.total_invariant,
                row.total_before, row.total_after);
  }
  std::printf("\n");
}

}  // namespace

void printLeal(const LealData& data, int seeds) {
  printStudy(data, seeds);
  printParticles(data, seeds);
  printExample(data);
  printObserver(data);
}

}  // namespace gaussmap::benchmark
