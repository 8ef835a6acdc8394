// SPDX-License-Identifier: BSD-3-Clause
#include "papers/leal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace gaussmap::papers {
using benchmark::LealMethod;
using benchmark::LealStudyRow;

namespace {

bool isSame(double a, double b) {
  return std::abs(a - b) < 1e-9;
}

/// The rows of one method with the threshold by which the claims are judged, by increasing l_min.
std::vector<LealStudyRow> rowsOf(const LealResults& results, LealMethod method) {
  std::vector<LealStudyRow> rows;
  for (const LealStudyRow& row : results.study)
    if (row.method == method && isSame(row.sigma_threshold, results.sigma_threshold)) rows.push_back(row);
  return rows;
}
benchmark::LealMeasure at(const LealResults& results, LealMethod method, double min_length) {
  const std::vector<LealStudyRow> rows = rowsOf(results, method);
  const auto isNearer = [=](const LealStudyRow& a, const LealStudyRow& b) {
    return std::abs(a.min_length - min_length) < std::abs(b.min_length - min_length);
  };
  return std::min_element(rows.begin(), rows.end(), isNearer)->map;
}
benchmark::LealMeasure printedAt(const LealResults& results, double min_length) {
  return at(results, LealMethod::AsPrinted, min_length);
}

std::string orDash(double value, const std::string& text) {
  return std::isnan(value) ? "-" : text;
}
std::string centimetres(double metres) {
  return orDash(metres, number(100.0 * metres));
}

std::string fileName(const LealResults& results, const std::string& what) {
  std::string name = "Leal " + results.data.name + " " + what;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

void addStudy(const LealResults& results, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const LealStudyRow& row : results.study) {
    if (row.method != LealMethod::Default && !isSame(row.sigma_threshold, results.sigma_threshold)) continue;
    const benchmark::LealMeasure& map = row.map;
    rows.push_back({nameOf(row.method), orDash(row.min_length, number(row.min_length)),
                    centimetres(std::sqrt(map.normal_variance)), number(map.segments), number(map.splits),
                    number(map.merges),
                    number(map.length) + " (" + orDash(map.true_length, number(map.true_length)) + ")",
                    percent(map.within_5cm), percent(map.predicted_10cm), centimetres(map.rms)});
  }
  report.paragraph("sigma_th = " + centimetres(results.sigma_threshold) + " cm:");
  report.table(
      {"method", "l_min [m]", "normal deviation [cm]", "segments", "splits", "merges", "length (of the true walls) [m]",
       "other scans within 5 cm", "other rays predicted within 10 cm", "RMS distance of other scans [cm]"},
      rows);
  app::LinePlot variance, counts;
  variance.x = counts.x = {"l_min [m]", app::AxisScale::Linear};
  variance.y = {"normal variance [cm^2]", app::AxisScale::Linear};
  counts.y = {"number", app::AxisScale::Logarithmic};
  int colour = 0;
  for (const LealMethod method : {LealMethod::AsPrinted, LealMethod::Moments}) {
    app::PlotLine line{nameOf(method), {}, ++colour, false};
    for (const LealStudyRow& row : rowsOf(results, method))
      line.points.emplace_back(row.min_length, 1e4 * row.map.normal_variance);
    variance.lines.push_back(line);
  }
  for (const auto& [name, value] : {std::pair{"segments", &benchmark::LealMeasure::segments},
                                    {"splits", &benchmark::LealMeasure::splits},
                                    {"merges", &benchmark::LealMeasure::merges}}) {
    app::PlotLine line{std::string(name) + ", as printed", {}, static_cast<int>(counts.lines.size()), false};
    for (const LealStudyRow& row : rowsOf(results, LealMethod::AsPrinted))
      line.points.emplace_back(row.min_length, std::max(1.0, row.map.*value));
    counts.lines.push_back(line);
  }
  report.picture(variance, fileName(results, "variance"),
                 "Like Fig. 7, " + results.data.name + ": variance of the evidence across the segments");
  report.picture(counts, fileName(results, "counts"),
                 "Like Fig. 8, " + results.data.name + ": segments, splits and merges");
}

void addParticles(const LealResults& results, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const benchmark::LealParticleRow& row : results.particles)
    rows.push_back({std::to_string(row.samples), number(row.per_metre), row.in_bins ? "per 0.25 m" : "per segment",
                    number(row.map.segments), number(row.map.length), percent(row.map.within_5cm),
                    percent(row.map.predicted_10cm), orDash(row.map.recall, percent(row.map.recall))});
  report.paragraph("Other numbers of particles, as printed, with l_min = 1 m and sigma_th = 6 cm:");
  report.table({"per observation", "per metre", "limit", "segments", "length [m]", "other scans within 5 cm",
                "other rays predicted within 10 cm", "true walls found"},
               rows);
}

void addExample(const LealResults& results, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const benchmark::LealExampleRow& row : results.example)
    rows.push_back({nameOf(row.method), centimetres(row.sigma_threshold),
                    row.method == LealMethod::Default ? "description length"
                    : row.dependent                   ? "eq. (5)"
                                                      : "eq. (4)",
                    number(row.segments), number(row.length), centimetres(std::sqrt(row.normal_variance))});
  report.paragraph("A part of 7 m x 8 m as in Figs. 4 and 5, with l_min = 1.5 m and alpha = 0.53 (`--view-scale`):");
  report.table({"method", "sigma_th [cm]", "utility", "segments", "length [m]", "normal deviation [cm]"}, rows);
}

void addObserver(const LealResults& results, Report& report) {
  std::vector<std::vector<std::string>> rows;
  for (const benchmark::LealObserverRow& row : results.observer)
    rows.push_back({nameOf(row.method), centimetres(row.sigma_threshold), number(row.before.segments),
                    number(row.there.segments), number(row.unvisited.segments), number(row.after.segments),
                    number(row.total_invariant), number(row.total_before), number(row.total_after)});
  report.paragraph(
      "An observer walks through the finished map as in Fig. 9, with eq. (5), l_min = 3 m and alpha = 0.33 "
      "(`--view-scale`). The first four columns of numbers are mean numbers of segments within 5 m of a place of its "
      "path. An observer has left a place when it is 15 m away. The last three columns are the segments of the whole "
      "map:");
  report.table(
      {"method", "sigma_th [cm]", "near a place, no observer", "while it is there", "places that it left, before",
       "after it left", "whole map, eq. (4)", "eq. (5), no observer", "eq. (5), after it left"},
      rows);
}

/// "simulated plan: 9.1 mm; Intel lab: 20 mm"
template <typename Text>
std::string onAll(const std::vector<LealResults>& all, const Text& text) {
  std::string list;
  for (const LealResults& results : all) list += (list.empty() ? "" : "; ") + results.data.name + ": " + text(results);
  return list;
}

/// "True.", or on which data it is true and on which not. `remark` is added.
template <typename Condition>
std::string verdictOn(const std::vector<LealResults>& all, const Condition& holds, const std::string& remark = "") {
  std::string yes, no;
  for (const LealResults& results : all) {
    std::string& list = holds(results) ? yes : no;
    list += (list.empty() ? "" : ", ") + results.data.name;
  }
  const std::string verdict = no.empty()    ? "True."
                              : yes.empty() ? "Not here."
                                            : "True on " + yes + "; not on " + no + ".";
  return remark.empty() ? verdict : verdict + " " + remark;
}

double bestMinLength(const LealResults& results) {
  const std::vector<LealStudyRow> rows = rowsOf(results, LealMethod::AsPrinted);
  const auto isWorse = [](const LealStudyRow& a, const LealStudyRow& b) {
    return a.map.predicted_10cm < b.map.predicted_10cm;
  };
  return std::max_element(rows.begin(), rows.end(), isWorse)->min_length;
}

void claimMinLength(const std::vector<LealResults>& all, Report& report) {
  report.claim({"Leal", "sec. 5, Fig. 6", "The best l_min is about 1 m",
                "l_min of the map that predicts the most rays of other scans within 10 cm: " +
                    onAll(all, [](const LealResults& one) { return number(bestMinLength(one)) + " m"; }),
                verdictOn(all, [](const LealResults& one) {
                  const double best = bestMinLength(one);
                  return best >= 0.7 && best <= 1.5;
                })});
  report.claim({"Leal", "sec. 5, Fig. 7", "With l_min of 0.7 m or less, segments fit the noise and not the walls",
                "rays of other scans predicted within 10 cm, and length of the map, with l_min = 0.5 m and 1 m: " +
                    onAll(all,
                          [](const LealResults& one) {
                            const benchmark::LealMeasure small = printedAt(one, 0.5), large = printedAt(one, 1.0);
                            return percent(small.predicted_10cm) + ", " + number(small.length) + " m and " +
                                   percent(large.predicted_10cm) + ", " + number(large.length) + " m";
                          }),
                verdictOn(
                    all,
                    [](const LealResults& one) {
                      return printedAt(one, 0.5).predicted_10cm < printedAt(one, 1.0).predicted_10cm;
                    },
                    "It depends on sigma_th: if sigma_th is well above the noise, l_min hardly matters.")});
  report.claim({"Leal", "sec. 5, Fig. 7", "From l_min = 1.5 m on, the error of the map is large",
                "normal deviation [cm] with l_min = 1 / 1.5 / 3 m: " +
                    onAll(all,
                          [](const LealResults& one) {
                            std::string text;
                            for (const double min_length : {1.0, 1.5, 3.0})
                              text += (text.empty() ? "" : " / ") +
                                      centimetres(std::sqrt(printedAt(one, min_length).normal_variance));
                            return text;
                          }),
                verdictOn(
                    all,
                    [](const LealResults& one) {
                      return printedAt(one, 3.0).normal_variance > 1.2 * printedAt(one, 1.0).normal_variance;
                    },
                    "It does not jump at 1.5 m.")});
}

void claimCounts(const std::vector<LealResults>& all, Report& report) {
  report.claim({"Leal", "sec. 5, Fig. 8", "A larger l_min gives fewer segments, splits and merges",
                "segments / splits / merges with l_min = 0.3 m and 3 m: " +
                    onAll(all,
                          [](const LealResults& one) {
                            const auto three = [](const benchmark::LealMeasure& map) {
                              return number(map.segments) + " / " + number(map.splits) + " / " + number(map.merges);
                            };
                            return three(printedAt(one, 0.3)) + " and " + three(printedAt(one, 3.0));
                          }),
                verdictOn(all, [](const LealResults& one) {
                  const benchmark::LealMeasure small = printedAt(one, 0.3), large = printedAt(one, 3.0);
                  return large.segments < small.segments && large.splits < small.splits && large.merges < small.merges;
                })});
}

/// Returns the measure with this number of particles. Throws std::out_of_range if it does not exist.
benchmark::LealMeasure withParticles(const LealResults& results, int samples, double per_metre, bool in_bins) {
  for (const benchmark::LealParticleRow& row : results.particles)
    if (row.samples == samples && isSame(row.per_metre, per_metre) && row.in_bins == in_bins) return row.map;
  throw std::out_of_range("no run with these particles");
}

void claimParticles(const std::vector<LealResults>& all, Report& report) {
  report.claim(
      {"Leal", "sec. 4.4, 5", "30 particles per observation and at most 300 per metre are enough",
       "beam ends of other scans within 5 cm of the map, with at most 300 / 3000 particles per metre: " +
           onAll(all,
                 [](const LealResults& one) {
                   return percent(withParticles(one, 30, 300.0, false).within_5cm) + " / " +
                          percent(withParticles(one, 30, 3000.0, false).within_5cm);
                 }),
       verdictOn(
           all,
           [](const LealResults& one) {
             return withParticles(one, 30, 300.0, false).within_5cm >
                    withParticles(one, 30, 3000.0, false).within_5cm - 0.02;
           },
           "A scan that sees only a part of a wall deletes particles of the whole wall, so the map loses walls.")});
}

void claimViewpoint(const std::vector<LealResults>& all, Report& report) {
  const auto detail = [](const LealResults& one) {
    double invariant = 0.0, dependent = 0.0;
    for (const benchmark::LealExampleRow& row : one.example)
      if (row.method == LealMethod::AsPrinted && isSame(row.sigma_threshold, one.sigma_threshold))
        (row.dependent ? dependent : invariant) = row.segments;
    return dependent / invariant;
  };
  report.claim(
      {"Leal", "sec. 4.2, Figs. 4, 5", "The viewpoint-dependent utility gives more detail near the observer",
       "number of segments in a part of 7 m x 8 m, with eq. (5) divided by with eq. (4): " +
           onAll(all, [&](const LealResults& one) { return times(detail(one)); }),
       verdictOn(
           all, [&](const LealResults& one) { return detail(one) > 1.1; }, "Straight walls have no detail to add.")});
  const auto rowOf = [](const LealResults& one) {
    for (const benchmark::LealObserverRow& row : one.observer)
      if (row.method == LealMethod::AsPrinted && isSame(row.sigma_threshold, one.sigma_threshold)) return row;
    throw std::out_of_range("no run with an observer");
  };
  const auto there = [&](const LealResults& one) { return rowOf(one).there.segments / rowOf(one).before.segments; };
  const auto after = [&](const LealResults& one) { return rowOf(one).after.segments / rowOf(one).unvisited.segments; };
  report.claim({"Leal", "sec. 5, Fig. 9", "An observer that moves through the map has more detail near it",
                "number of segments near a place, with the observer divided by without it: " +
                    onAll(all, [&](const LealResults& one) { return times(there(one)); }),
                verdictOn(all, [&](const LealResults& one) { return there(one) > 1.05; })});
  report.claim(
      {"Leal", "sec. 4.2", "Elsewhere, the map reverts to the viewpoint-invariant utility",
       "number of segments near a place, after the observer left divided by before it came: " +
           onAll(all, [&](const LealResults& one) { return times(after(one)); }),
       verdictOn(
           all, [&](const LealResults& one) { return after(one) < 1.1; },
           "The printed eq. (5) has no rule for this. This library adds a rule, which also merges some short segments "
           "that eq. (4) keeps.")});
}

}  // namespace

LealResults runLeal(benchmark::LealData data, double sigma_threshold, int seeds) {
  LealResults results;
  results.sigma_threshold = sigma_threshold;
  results.particles = lealParticles(data, seeds);
  results.study = lealStudy(data, seeds);
  results.example = lealExample(data);
  results.observer = lealObserver(data);
  results.data = std::move(data);
  return results;
}

void reportLeal(const std::vector<LealResults>& all, Report& report) {
  report.heading(2, "Leal, sections 4.2 and 5: maps of segments");
  report.paragraph(
      "The normal deviation is the standard deviation of the evidence across a segment, sigma_n. A segment is split if "
      "this exceeds sigma_th and the segment is at least l_min long. The paper does not give sigma_th. Here it is near "
      "the noise of the particles: 2.8 cm for the simulated places, and 6 cm for the log, whose poses are less exact. "
      "Eq. (4) is the viewpoint-invariant utility, eq. (5) the viewpoint-dependent one. *moments, eq. (4)* keeps exact "
      "moments instead of particles.");
  report.paragraph(
      "\"Other scans\" are scans that the map does not contain. \"Other scans within 5 cm\" is the share of their beam "
      "ends that lie within 5 cm of a segment. \"Other rays predicted within 10 cm\" is the share of their rays that "
      "meet the first segment within 10 cm of the measured range. For simulated places, the other scans have no noise, "
      "so their distances are errors of the map. `gaussmap_benchmark segments --study` prints more rows.");
  for (const LealResults& results : all) {
    report.heading(3, results.data.name + ", " + std::to_string(results.data.scans.size()) + " scans");
    addStudy(results, report);
    addParticles(results, report);
    addExample(results, report);
    addObserver(results, report);
  }
  claimMinLength(all, report);
  claimCounts(all, report);
  claimParticles(all, report);
  claimViewpoint(all, report);
}

}  // namespace gaussmap::papers
