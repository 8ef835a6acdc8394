// SPDX-License-Identifier: BSD-3-Clause
// gaussmap hausdorff MAP|CLOUD REFERENCE...: distances of a map or a cloud to points, a mesh or another map; or the
// likelihood of points under a map.
#include "commands/hausdorff/hausdorff.h"

#include <algorithm>
#include <map>
#include <memory>

#include "commands/commands.h"
#include "common/command.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
namespace {

const Help kHausdorffHelp = {
    "Distances between a map (or cloud) and a reference, in both directions",
    "gaussmap hausdorff street.gmap scans/ --scale 2",
    R"(A map is sampled; samples outside the bounds of their Gaussian (--samples-in) are rejected. The maximum over the
samples grows with their number, so compare maxima only at equal --samples. Or use the quantiles, or the rows
"2 sigma", whose samples fill the ellipsoids of 2 standard deviations.

References: clouds are combined as in pcd2map. For a mesh, map->ref are exact distances to its surface, ref->map are
those of --samples points on it. Of another map, the scale of the same number is sampled in the same way, so that the
distance of equal maps is 0.

--held-out: each reference point x scores ln((1 - e) p(x) + e / V), where p is the density of the scale in 1/m^3 (the
Gaussians of the cell of x and of its neighbours), e is --background, and V the volume of the box around the points
(each side at least 1 m). A point far from all Gaussians ("nowhere") scores the floor ln(e / V). Larger is better.
Compare scores of the same points only. Make sure that the map was not built from these points.

--write-errors: fields x y z error rgb. Colours: blue = 0, cyan, green, yellow, red = 99 % quantile and above.

More examples: gaussmap hausdorff street.gmap street.ply --scale 2 --write-errors errors.pcd
               gaussmap hausdorff street.gmap scans_never_used/ --held-out)"};

const std::map<std::string, SampleShare> kShares = {{"volume", SampleShare::Volume}, {"mass", SampleShare::Mass}};
const std::map<std::string, SampleBounds> kBounds = {{"members", SampleBounds::MemberCells},
                                                     {"cell", SampleBounds::Cell}};

bool isMesh(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; });
  return ending == ".ply";
}

ReferenceKind kindOf(const std::vector<std::string>& paths) {
  if (paths.size() != 1) return ReferenceKind::Cloud;
  return isMesh(paths.front()) ? ReferenceKind::Mesh : isMap(paths.front()) ? ReferenceKind::Map : ReferenceKind::Cloud;
}

/// Throws UsageError for options that do not go together.
void check(const HausdorffCommand& command, bool of_map, ReferenceKind reference) {
  const bool writes = !command.errors.path.empty();
  if (isMesh(command.subject)) throw UsageError(command.subject + ": a mesh can only be the reference");
  for (const std::string& path : command.reference.paths)
    if (isMesh(path) && command.reference.paths.size() > 1)
      throw UsageError(path + ": a mesh must be the only reference");
  if (reference != ReferenceKind::Cloud && !command.reference.poses.empty())
    throw UsageError("--poses: " + command.onlyReference() + " is no cloud");
  if (command.held_out && !(of_map && reference == ReferenceKind::Cloud))
    throw UsageError("--held-out scores a map with the points of clouds");
  if (command.held_out && writes) throw UsageError("--write-errors writes distances: leave out --held-out");
  if (command.max_only && (of_map || reference != ReferenceKind::Cloud || command.held_out))
    throw UsageError("--max-only compares clouds with clouds");
  if (command.max_only && writes) throw UsageError("--write-errors needs all distances: leave out --max-only");
  if (!of_map && reference == ReferenceKind::Map)
    throw UsageError(command.onlyReference() + ": to compare a cloud with a map, name the map first");
  if (!writes) return;
  std::vector<std::filesystem::path> inputs(command.reference.paths.begin(), command.reference.paths.end());
  inputs.emplace_back(command.subject);
  requireExtension(command.errors.path, ".pcd");
  checkOutput(command.errors, inputs);
}

void run(const HausdorffCommand& command) {
  const bool of_map = isMap(command.subject);
  const ReferenceKind reference = kindOf(command.reference.paths);
  check(command, of_map, reference);
  if (command.held_out) return scoreMap(command);
  if (command.max_only) return compareMaxima(command);
  if (of_map) return compareMap(command, reference);
  compareCloud(command, reference);
}

void addSampleOptions(Command& command, SampleOptions& samples) {
  command.number("--samples", samples.samples, 1, 100000000, "samples of a scale, divided among its Gaussians");
  command.number("--at-least", samples.at_least, 1, 1000000, "samples of every Gaussian").rare();
  command
      .choiceOf("--sampling", samples.share, kShares, "samples in proportion to ellipsoid volume, or to weight (mass)")
      .rare();
  command
      .choiceOf("--samples-in", samples.bounds, kBounds,
                "where samples of a Gaussian may lie: in the box of the finest cells that it represents, or (as in the "
                "paper) anywhere in its cell")
      .rare();
  command.seed(samples.seed, "seed of the samples").rare();
}

}  // namespace

void addHausdorff(CLI::App& app) {
  auto options = std::make_shared<HausdorffCommand>();
  Command command(app, "hausdorff", kHausdorffHelp);
  command.text("subject", options->subject, "map (.gmap, or PCD of Gaussians), or a PCD cloud or directory").required();
  command
      .texts("reference", options->reference.paths, "PCD files or directories of them, or one mesh (PLY), or one map")
      .required();
  const Option scale = command.scale(options->scale, "only this scale, 0 = finest; default: all");
  command.flag("--leaves", options->leaves, "compare all leaves of a compressed map at once").excludes(scale);
  addSampleOptions(command, options->samples);
  command.flag("--max-only", options->max_only, "only the maxima of two clouds, which is faster");
  command.flag("--held-out", options->held_out, "mean log-likelihood of the reference points under the map");
  command
      .number("--background", options->scoring.background, 1e-12, 0.999999, "--held-out: share of points from anywhere")
      .rare();
  command.text("--write-errors", options->errors.path, "PCD file to write: points coloured by their distance");
  command
      .choice("--direction", options->direction, {"forward", "backward"},
              "--write-errors: forward = samples of the map, or points of the cloud; backward = the reference")
      .rare();
  command.force(options->errors.force, "replace an existing file of errors");
  addScanOptions(command, options->reference);
  command.threads(options->samples.threads);
  command.json(options->json);
  command.files({"subject"}, {".gmap", ".pcd"});
  command.files({"reference"}, {".pcd", ".ply", ".gmap"});
  command.files({"--write-errors"}, {".pcd"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
