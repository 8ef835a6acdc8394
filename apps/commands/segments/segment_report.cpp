// SPDX-License-Identifier: BSD-3-Clause
#include "commands/segments/segment_report.h"

#include <cmath>
#include <iostream>

#include "common/report.h"

namespace gaussmap::app {
using namespace detail;

namespace {

std::string percent(double share) {
  return formatted("%.1f %%", 100.0 * share);
}
std::string centimetres(double metres) {
  return formatted("%.2f cm", 100.0 * metres);
}

}  // namespace

void printScore(const HoldOutScore& score, std::size_t scans) {
  std::cout << "held out: " << scans << " scans, " << score.beams << " beams; ends within 5 cm "
            << percent(score.within_5cm) << ", within 10 cm " << percent(score.within_10cm) << ", rms "
            << centimetres(score.rms) << "; rays predicted within 10 cm " << percent(score.predicted_10cm)
            << ", blocked more than 20 cm early " << percent(score.blocked_early) << '\n';
}
Json scoreJson(const HoldOutScore& score, std::size_t scans) {
  return {{"scans", scans},   {"beams", score.beams},        {"cov5", score.within_5cm},   {"cov10", score.within_10cm},
          {"rms", score.rms}, {"r10", score.predicted_10cm}, {"viol", score.blocked_early}};
}

void printScore(const WallScore& score) {
  std::cout << "walls: recall " << percent(score.recall) << ", precision " << percent(score.precision)
            << " within 5 cm; offset " << centimetres(score.offset_rms) << ", angle "
            << formatted("%.2f degrees", score.angle_rms * 180.0 / std::acos(-1.0)) << " (rms of " << score.matched
            << " segments), normalised error " << formatted("%.2f", score.normalised_error) << "; corners "
            << centimetres(score.corner_median) << " (median of " << score.corners << ")\n";
}
Json scoreJson(const WallScore& score) {
  return {{"recall", score.recall},       {"precision", score.precision},
          {"matched", score.matched},     {"offset_rms", score.offset_rms},
          {"angle_rms", score.angle_rms}, {"normalised_error", score.normalised_error},
          {"corners", score.corners},     {"corner_median", score.corner_median}};
}

}  // namespace gaussmap::app
