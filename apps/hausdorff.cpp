// SPDX-License-Identifier: BSD-3-Clause
// gaussmap hausdorff MAP|CLOUD REFERENCE...: how far a map, or a cloud, is from a reference.
#include "gaussmap/evaluation/hausdorff.h"

#include <cstdio>
#include <iostream>

#include "common.h"
#include "gaussmap/io/map_pcd.h"

namespace gaussmap::app {
namespace {

struct HausdorffCommand {
  std::string subject;
  ScanInput reference;
  int scale = -1;
  std::string sampling = "volume";
  SampleOptions samples;
  bool json = false;
};

Json jsonOf(const DistanceSummary& summary) {
  if (summary.count == 0) return nullptr;
  return {{"max", summary.max},   {"q99", summary.q99}, {"q95", summary.q95},
          {"mean", summary.mean}, {"rms", summary.rms}, {"count", summary.count}};
}

Json jsonOf(const HausdorffResult& result) {
  return {{"forward", jsonOf(result.forward)},
          {"backward", jsonOf(result.backward)},
          {"hausdorff", result.forward.count && result.backward.count ? Json(result.hausdorff()) : Json(nullptr)}};
}

void printRow(const char* scale, const char* samples, const char* direction, const DistanceSummary& s) {
  if (s.count > 0)
    std::printf("%-6s %-9s %-10s %10.4g %10.4g %10.4g %10.4g %10.4g %10zu\n", scale, samples, direction, s.max, s.q99,
                s.q95, s.mean, s.rms, s.count);
}

void printRows(const std::string& scale, const char* samples, const char* from, const char* to,
               const HausdorffResult& result) {
  printRow(scale.c_str(), samples, (std::string(from) + "->" + to).c_str(), result.forward);
  printRow(scale.c_str(), samples, (std::string(to) + "->" + from).c_str(), result.backward);
}

void printHead() {
  std::printf("%-6s %-9s %-10s %10s %10s %10s %10s %10s %10s\n", "scale", "samples", "direction", "max", "99%", "95%",
              "mean", "rms", "points");
}

void compareMap(const HausdorffCommand& options, const std::vector<Vector<3>>& reference) {
  const GaussianMap<3> map = loadAnyMap(options.subject);
  if (options.scale >= map.scales())
    throw UsageError("--scale " + std::to_string(options.scale) + ": the map has the scales 0 to " +
                     std::to_string(map.scales() - 1));
  Json all = Json::array();
  if (!options.json) printHead();
  for (int s = 0; s < map.scales(); ++s) {
    if (options.scale >= 0 && options.scale != s) continue;
    const MapHausdorff result = evaluateMap(map, s, reference, options.samples);
    if (options.json) {
      all.push_back({{"scale", s},
                     {"gaussians", result.gaussians},
                     {"samples", result.samples},
                     {"unplaced", result.unplaced},
                     {"all", jsonOf(result.all)},
                     {"within_two_sigma", jsonOf(result.within_two_sigma)}});
      continue;
    }
    printRows(std::to_string(s), "all", "map", "ref", result.all);
    printRows(std::to_string(s), "2 sigma", "map", "ref", result.within_two_sigma);
  }
  if (options.json) printJson({{"map", options.subject}, {"scales", all}});
}

void run(HausdorffCommand options) {
  options.samples.share = options.sampling == "mass" ? SampleShare::Mass : SampleShare::Volume;
  const AccumulateOptions reading = accumulateOptions(options.reference, 1.0, options.samples.threads);
  const std::vector<ScanSource> scans = findScans(options.reference);
  const std::vector<Vector<3>> reference = readScans(scans, reading);
  if (reference.empty()) throw std::runtime_error(nameOf(scans) + ": no point of the reference is usable");
  if (isMap(options.subject)) return compareMap(options, reference);
  ScanInput cloud = options.reference;
  cloud.paths = {options.subject};
  cloud.poses.clear();
  const std::vector<Vector<3>> points = readScans(findScans(cloud), reading);
  if (points.empty()) throw std::runtime_error(options.subject + ": no point is usable");
  const HausdorffResult result = hausdorff(points, reference, options.samples.threads);
  if (options.json) {
    printJson({{"cloud", options.subject}, {"all", jsonOf(result)}});
    return;
  }
  printHead();
  printRows("-", "points", "cloud", "ref", result);
}

}  // namespace

void addHausdorff(CLI::App& app) {
  auto options = std::make_shared<HausdorffCommand>();
  CLI::App* command = app.add_subcommand("hausdorff", "Distances between a map (or cloud) and a reference, both ways");
  command->footer(
      "A map is sampled: samples outside the cell of their Gaussian are rejected. The maximum over samples of a\n"
      "Gaussian grows with their number, since it has no end but its cell's: compare maxima at equal --samples only,\n"
      "or take the quantiles, or the rows '2 sigma', whose samples fill the ellipsoids of 2 standard deviations.\n"
      "The reference are PCD files or directories, taken together as pcd2map takes them.\n"
      "Example: gaussmap hausdorff street.gmap scans/ --scale 2");
  command->add_option("subject", options->subject, "map (.gmap, or PCD of Gaussians), or a PCD cloud")->required();
  command->add_option("reference", options->reference.paths, "PCD files or directories of them")->required();
  command->add_option("--scale", options->scale, "only this scale, 0 = finest; default: all")->check(CLI::Range(0, 63));
  command->add_option("--samples", options->samples.samples, "samples of a scale, shared out among its Gaussians")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  command->add_option("--at-least", options->samples.at_least, "samples of every Gaussian")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--sampling", options->sampling, "samples in proportion to ellipsoid volume, or to weight")
      ->check(CLI::IsMember({"volume", "mass"}))
      ->capture_default_str();
  addSeed(*command, options->samples.seed, "of the samples");
  addScanOptions(*command, options->reference);
  addThreads(*command, options->samples.threads);
  command->add_flag("--json", options->json, "print for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
