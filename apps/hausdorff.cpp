// SPDX-License-Identifier: BSD-3-Clause
// gaussmap hausdorff MAP|CLOUD REFERENCE...: how far a map, or a cloud, is from points, a mesh or another map; or how
// well a map foretells points.
#include "gaussmap/evaluation/hausdorff.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "common.h"
#include "evaluation/error_cloud.h"
#include "gaussmap/evaluation/held_out.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/ply/ply.h"
#include "gaussmap/map/queries.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct HausdorffCommand {
  std::string subject;
  ScanInput reference;
  int scale = -1;
  bool leaves = false;
  std::string sampling = "volume";
  std::string samples_in = "members";
  SampleOptions samples;
  bool max_only = false;
  bool held_out = false;
  HeldOutOptions scoring;
  Output errors;
  std::string direction = "forward";
  bool json = false;

  std::string onlyReference() const { return reference.paths.size() == 1 ? reference.paths.front() : std::string(); }
};

enum class Kind { Cloud, Mesh, Map };

bool isMesh(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return ending == ".ply";
}

Kind kindOf(const std::string& path) {
  return isMesh(path) ? Kind::Mesh : isMap(path) ? Kind::Map : Kind::Cloud;
}

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

std::vector<Vector<3>> readPoints(const ScanInput& input, int threads) {
  const PcdScans scans = openScans(input);
  std::vector<Vector<3>> points = readPoints(scans, accumulateOptions(input, 1.0, threads));
  if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
  return points;
}

std::vector<Vector<3>> readSubject(const HausdorffCommand& options) {
  ScanInput cloud = options.reference;  // for the frame and the range
  cloud.paths = {options.subject};
  cloud.poses.clear();
  return readPoints(cloud, options.samples.threads);
}

/// A scale; none: the map at its finest, all its leaves.
using Level = std::optional<int>;

std::string wordOf(const Level& level) {
  return level ? std::to_string(*level) : "leaves";
}

Json jsonOf(const Level& level) {
  return level ? Json(*level) : Json("leaves");
}

/// What to look at of some maps: what the user chose, else every scale that all of them have, and if one is
/// compressed, first the leaves.
std::vector<Level> chosenLevels(const HausdorffCommand& options, const std::vector<const GaussianMap<3>*>& maps) {
  if (options.leaves) return {std::nullopt};
  int scales = maps.front()->scales();
  bool compressed = false;
  for (const GaussianMap<3>* map : maps) {
    scales = std::min(scales, map->scales());
    compressed |= map->isCompressed();
  }
  if (options.scale >= scales)
    throw UsageError("--scale " + std::to_string(options.scale) + ": the map has the scales 0 to " +
                     std::to_string(scales - 1));
  if (options.scale >= 0) return {options.scale};
  std::vector<Level> levels;
  if (compressed) levels.push_back(std::nullopt);
  for (int s = 0; s < scales; ++s)
    if (!compressed || std::all_of(maps.begin(), maps.end(), [&](auto* map) { return map->cellCount(s) > 0; }))
      levels.emplace_back(s);
  return levels;
}

Json writeErrors(const HausdorffCommand& options, const std::vector<Vector<3>>& reference,
                 const PointDistances& distances) {
  const bool forward = options.direction == "forward";
  const std::vector<Vector<3>>& points = forward ? distances.subject : reference;
  writeErrorCloud(options.errors.path, points, forward ? distances.forward : distances.backward);
  if (!options.json) std::cout << options.errors.path << ": " << points.size() << " points\n";
  return {{"file", options.errors.path}, {"direction", options.direction}, {"points", points.size()}};
}

Reference readMesh(const HausdorffCommand& options) {
  return Reference(readPly(options.onlyReference()), options.samples.samples, options.samples.seed);
}

void compareMap(const HausdorffCommand& options, Kind kind) {
  std::optional<Reference> reference;
  std::optional<GaussianMap<3>> other;
  if (kind == Kind::Map)
    other = loadAnyMap(options.onlyReference());
  else if (kind == Kind::Mesh)
    reference = readMesh(options);
  else
    reference = Reference(readPoints(options.reference, options.samples.threads));
  const GaussianMap<3> map = loadAnyMap(options.subject);
  std::vector<const GaussianMap<3>*> maps = {&map};
  if (other) maps.push_back(&*other);
  const std::vector<Level> levels = chosenLevels(options, maps);
  if (!options.errors.path.empty() && levels.size() > 1)
    throw UsageError("--write-errors writes one cloud: choose a --scale, or --leaves");

  Json all = Json::array(), written;
  if (!options.json) printHead();
  for (const Level& level : levels) {
    const SampleOptions& samples = options.samples;
    if (other) reference = Reference(level ? sampleMap(*other, *level, samples) : sampleLeaves(*other, samples));
    PointDistances distances;
    const MapHausdorff result = level ? reference->compare(map, *level, samples, &distances)
                                      : reference->compareLeaves(map, samples, &distances);
    all.push_back({{"scale", jsonOf(level)},
                   {"gaussians", result.gaussians},
                   {"samples", result.samples},
                   {"unplaced", result.unplaced},
                   {"all", jsonOf(result.all)},
                   {"within_two_sigma", jsonOf(result.within_two_sigma)}});
    if (!options.json) {
      printRows(wordOf(level), "all", "map", "ref", result.all);
      printRows(wordOf(level), "2 sigma", "map", "ref", result.within_two_sigma);
    }
    if (!options.errors.path.empty()) written = writeErrors(options, reference->points(), distances);
  }
  if (!options.json) return;
  Json json = {{"map", options.subject}, {"scales", all}};
  if (!written.is_null()) json["errors"] = written;
  printJson(json);
}

void compareCloud(const HausdorffCommand& options, Kind kind) {
  const int threads = options.samples.threads;
  PointDistances distances, *const wanted = options.errors.path.empty() ? nullptr : &distances;
  HausdorffResult result;
  std::vector<Vector<3>> points;
  if (kind == Kind::Cloud) {
    points = readPoints(options.reference, threads);
    result = hausdorff(readSubject(options), points, threads, wanted);
  } else {
    const Reference mesh = readMesh(options);
    points = mesh.points();
    result = mesh.compare(readSubject(options), threads, wanted);
  }
  if (!options.json) {
    printHead();
    printRows("-", "points", "cloud", "ref", result);
  }
  Json json = {{"cloud", options.subject}, {"all", jsonOf(result)}};
  if (wanted != nullptr) json["errors"] = writeErrors(options, points, distances);
  if (options.json) printJson(json);
}

void compareMaxima(const HausdorffCommand& options) {
  const std::vector<Vector<3>> reference = readPoints(options.reference, options.samples.threads);
  const HausdorffMaxima maxima = hausdorffMaxima(readSubject(options), reference, options.samples.threads);
  if (options.json)
    return printJson({{"cloud", options.subject},
                      {"all",
                       {{"forward", {{"max", maxima.forward}}},
                        {"backward", {{"max", maxima.backward}}},
                        {"hausdorff", maxima.hausdorff()}}}});
  std::printf("%-10s %10s\n%-10s %10.4g\n%-10s %10.4g\n", "direction", "max", "cloud->ref", maxima.forward,
              "ref->cloud", maxima.backward);
}

void scoreMap(const HausdorffCommand& options) {
  const std::vector<Vector<3>> points = readPoints(options.reference, options.samples.threads);
  const GaussianMap<3> map = loadAnyMap(options.subject);
  HeldOutOptions scoring = options.scoring;
  scoring.threads = options.samples.threads;
  Json all = Json::array();
  if (!options.json)
    std::printf("%-6s %10s %10s %10s %10s %10s %10s %10s\n", "scale", "gaussians", "mean", "median", "floor", "no cell",
                "nowhere", "points");
  for (const Level& level : chosenLevels(options, {&map})) {
    const HeldOutResult result =
        level ? heldOutLogLikelihood<3>(map, *level, points, scoring) : heldOutLogLikelihood<3>(map, points, scoring);
    const std::size_t gaussians = level ? map.gaussianCount(*level) : leaves<3>(map).size();
    const double share = 1.0 / static_cast<double>(result.count);
    const double in_no_cell = share * static_cast<double>(result.in_no_cell);
    const double nowhere = share * static_cast<double>(result.nowhere);
    all.push_back({{"scale", jsonOf(level)},
                   {"gaussians", gaussians},
                   {"mean", result.mean},
                   {"median", result.median},
                   {"floor", result.floor},
                   {"volume", result.volume},
                   {"in_no_cell", in_no_cell},
                   {"nowhere", nowhere},
                   {"points", result.count}});
    if (!options.json)
      std::printf("%-6s %10zu %10.4f %10.4f %10.4f %9.3f%% %9.3f%% %10zu\n", wordOf(level).c_str(), gaussians,
                  result.mean, result.median, result.floor, 100.0 * in_no_cell, 100.0 * nowhere, result.count);
  }
  if (options.json) printJson({{"map", options.subject}, {"background", scoring.background}, {"scales", all}});
}

/// Options that do not go together.
void check(const HausdorffCommand& options, bool of_map, Kind reference) {
  const bool writes = !options.errors.path.empty();
  if (isMesh(options.subject)) throw UsageError(options.subject + ": a mesh can only be the reference");
  for (const std::string& path : options.reference.paths)
    if (isMesh(path) && options.reference.paths.size() > 1)
      throw UsageError(path + ": a mesh must be the only reference");
  if (reference != Kind::Cloud && !options.reference.poses.empty())
    throw UsageError("--poses: " + options.onlyReference() + " is no cloud");
  if (options.held_out && !(of_map && reference == Kind::Cloud))
    throw UsageError("--held-out scores a map with the points of clouds");
  if (options.held_out && writes) throw UsageError("--write-errors writes distances: leave out --held-out");
  if (options.max_only && (of_map || reference != Kind::Cloud || options.held_out))
    throw UsageError("--max-only compares clouds with clouds");
  if (options.max_only && writes) throw UsageError("--write-errors needs all distances: leave out --max-only");
  if (!of_map && reference == Kind::Map)
    throw UsageError(options.onlyReference() + ": to compare a cloud with a map, name the map first");
  if (!writes) return;
  std::vector<std::filesystem::path> inputs(options.reference.paths.begin(), options.reference.paths.end());
  inputs.emplace_back(options.subject);
  if (std::filesystem::path(options.errors.path).extension() != ".pcd")
    throw UsageError(options.errors.path + ": the name must end in .pcd");
  checkOutput(options.errors, inputs);
}

void run(HausdorffCommand options) {
  options.samples.share = options.sampling == "mass" ? SampleShare::Mass : SampleShare::Volume;
  options.samples.bounds = options.samples_in == "cell" ? SampleBounds::Cell : SampleBounds::MemberCells;
  const bool of_map = isMap(options.subject);
  const Kind reference = options.reference.paths.size() == 1 ? kindOf(options.onlyReference()) : Kind::Cloud;
  check(options, of_map, reference);
  if (options.held_out) return scoreMap(options);
  if (options.max_only) return compareMaxima(options);
  if (of_map) return compareMap(options, reference);
  compareCloud(options, reference);
}

}  // namespace

void addHausdorff(CLI::App& app) {
  auto options = std::make_shared<HausdorffCommand>();
  CLI::App* command = app.add_subcommand("hausdorff", "Distances between a map (or cloud) and a reference, both ways");
  command->footer(
      "A map is sampled: samples outside the bounds of their Gaussian (--samples-in) are rejected. The maximum over\n"
      "samples of a Gaussian grows with their number, since it has no other end: compare maxima at equal --samples\n"
      "only, or take the quantiles, or the rows '2 sigma', whose samples fill the ellipsoids of 2 standard "
      "deviations.\n"
      "Clouds as reference are taken together as pcd2map takes them. Against a mesh, map->ref are exact distances to\n"
      "its surface, ref->map those of --samples points spread over its area. Of a map as reference the scale of the\n"
      "same number is sampled in the same way: equal maps have distance 0.\n"
      "--held-out: each point x of the reference counts ln((1 - e) p(x) + e / V), p = the density of the map's scale\n"
      "in 1/m^3 (the Gaussians of the point's cell and the cells next to it), e = --background, V = the volume of\n"
      "the box around the points, each side at least 1 m. So a point where the map has nothing ('nowhere') counts\n"
      "the floor ln(e / V). Larger is better; compare by the same points only. That the map was built without them\n"
      "is yours to see to.\n"
      "--write-errors: fields x y z error rgb; blue = 0, cyan, green, yellow, red = the 99% quantile and above.\n"
      "Example: gaussmap hausdorff street.gmap scans/ --scale 2\n"
      "         gaussmap hausdorff street.gmap street.ply --scale 2 --write-errors errors.pcd\n"
      "         gaussmap hausdorff street.gmap scans_never_used/ --held-out");
  command->add_option("subject", options->subject, "map (.gmap, or PCD of Gaussians), or a PCD cloud or directory")
      ->required();
  command
      ->add_option("reference", options->reference.paths,
                   "PCD files or directories of them, or one mesh (PLY), or one map")
      ->required();
  CLI::Option* scale = command
                           ->add_option("--scale", options->scale,
                                        "only this scale, 0 = finest; default: all, and the leaves of a compressed map")
                           ->check(CLI::Range(0, 63));
  command
      ->add_flag(
          "--leaves", options->leaves,
          "the map at its finest, as a whole: of a compressed map the finest cells and the coarse ones that stand "
          "alone")
      ->excludes(scale);
  command->add_option("--samples", options->samples.samples, "samples of a scale, shared out among its Gaussians")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  command->add_option("--at-least", options->samples.at_least, "samples of every Gaussian")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--sampling", options->sampling, "samples in proportion to ellipsoid volume, or to weight")
      ->check(CLI::IsMember({"volume", "mass"}))
      ->capture_default_str();
  command
      ->add_option("--samples-in", options->samples_in,
                   "where samples of a Gaussian may lie: in the box of the finest cells that it stands for, or (as in "
                   "the paper) anywhere in its cell")
      ->check(CLI::IsMember({"members", "cell"}))
      ->capture_default_str();
  addSeed(*command, options->samples.seed, "of the samples");
  command->add_flag("--max-only", options->max_only, "of two clouds only the maxima, which are found faster");
  command->add_flag("--held-out", options->held_out, "mean log-likelihood of the reference points under the map");
  command->add_option("--background", options->scoring.background, "--held-out: share of points from anywhere")
      ->check(numberBetween(1e-12, 0.999999))
      ->capture_default_str();
  command->add_option("--write-errors", options->errors.path, "PCD file to write: points coloured by their distance");
  command
      ->add_option("--direction", options->direction,
                   "--write-errors: forward = samples of the map, or points of the cloud; backward = the reference")
      ->check(CLI::IsMember({"forward", "backward"}))
      ->capture_default_str();
  command->add_flag("--force", options->errors.force, "replace an existing file of errors");
  addScanOptions(*command, options->reference);
  addThreads(*command, options->samples.threads);
  command->add_flag("--json", options->json, "print for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
