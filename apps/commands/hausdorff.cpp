// SPDX-License-Identifier: BSD-3-Clause
// gaussmap hausdorff MAP|CLOUD REFERENCE...: measures the distances between a map or a cloud and a reference (points, a
// mesh or another map), or the likelihood of points under a map.
#include "commands/hausdorff/hausdorff.h"

#include <map>
#include <memory>

#include "commands/commands.h"
#include "common/command.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "io/ply/ply_header.h"

namespace gaussmap::app {
namespace {

const Help kHausdorffHelp = {
    "Measure the distances between a map (or cloud) and a reference, in both directions",
    "gaussmap hausdorff street.gmap scans/ --scale 2",
    R"(A map is sampled. Samples outside the bounds of their Gaussian (--samples-in) are rejected. The maximum distance
grows with the number of samples, so compare maxima only at equal --samples, or compare quantiles. The rows "2 sigma"
use only the samples within 2 standard deviations of their means.

--as-in-paper: --samples-in cell --at-least 0, as in Yguel et al. 2009. The number of samples is then exactly
proportional to the volume of the Gaussians. Options that are also given override these settings.

Clouds are combined as in pcd2map. A PLY file with faces is a mesh, without faces a cloud. For a mesh, map->ref are
exact distances to its surface, and ref->map are the distances of --samples points on it. Another map is sampled in
the same way at the same scale, so the distance of two equal maps is 0.

A planar map lies in the plane z = 0, and the heights of the points of scans are dropped. 3-D scans need --slice.

--held-out: a point x scores ln((1 - e) p(x) + e / V). p is the density of the scale [1/m^3] (planar: [1/m^2]), e is
--background, and V is the volume (planar: area) of the box around the points. A point far from all Gaussians
("nowhere") scores the floor ln(e / V).
Larger is better. Compare only scores of the same points. Make sure that the map was not built from these points.

--write-errors: fields x y z error rgb, from blue = 0 over cyan, green and yellow to red = 99 % quantile and above.

--check: computes the distances a second time with the exact kd-tree of FLANN, and fails if one differs by more than
rounding. The reference must be points or a map, not a mesh. The rows "2 sigma" are not checked.

More examples: gaussmap hausdorff street.gmap street.ply --scale 2 --write-errors errors.pcd
               gaussmap hausdorff street.gmap scans_never_used/ --held-out)"};

const std::map<std::string, SampleShare> kShares = {{"volume", SampleShare::Volume}, {"mass", SampleShare::Mass}};
const std::map<std::string, SampleBounds> kBounds = {{"members", SampleBounds::MemberCells},
                                                     {"cell", SampleBounds::Cell}};

bool isMesh(const std::string& path) {
  return endingOf(path) == ".ply" && detail::isPlyMesh(path);
}

ReferenceKind kindOf(const std::vector<std::string>& paths) {
  if (paths.size() != 1) return ReferenceKind::Cloud;
  return isMesh(paths.front()) ? ReferenceKind::Mesh : isMap(paths.front()) ? ReferenceKind::Map : ReferenceKind::Cloud;
}

/// Throws UsageError for options or inputs that cannot be combined, and if the errors cannot be written.
void check(const HausdorffCommand& command, bool of_map, ReferenceKind reference) {
  const bool writes = !command.errors.path.empty();
  if (isMesh(command.subject)) throw UsageError(command.subject + ": a mesh can only be the reference; name it last");
  for (const std::string& path : command.reference.paths)
    if (isMesh(path) && command.reference.paths.size() > 1)
      throw UsageError(path + ": a mesh must be the only reference");
  if (reference != ReferenceKind::Cloud && !command.reference.poses.empty())
    throw UsageError("--poses: only for clouds, but the reference is " + command.onlyReference());
  if (command.held_out && !(of_map && reference == ReferenceKind::Cloud))
    throw UsageError("--held-out: needs a map, and clouds as the reference");
  if (command.held_out && writes)
    throw UsageError("--write-errors: writes distances, which --held-out does not measure");
  if (command.max_only && (of_map || reference != ReferenceKind::Cloud || command.held_out))
    throw UsageError("--max-only: only for a cloud and clouds as the reference");
  if (command.max_only && writes) throw UsageError("--write-errors: needs all distances; leave out --max-only");
  if (!of_map && !command.slice.empty()) throw UsageError("--slice: only for planar maps; use --crop with heights");
  if (command.check && command.held_out)
    throw UsageError("--check: checks distances, which --held-out does not measure");
  if (command.check && reference == ReferenceKind::Mesh)
    throw UsageError("--check: FLANN has no distances to the surface of a mesh; compare with its points");
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
  if (command.held_out) return forMap(command.subject, [&](auto d) { scoreMap<d()>(command); });
  if (command.max_only) return compareMaxima(command);
  if (of_map) return forMap(command.subject, [&](auto d) { compareMap<d()>(command, reference); });
  compareCloud(command, reference);
}

void addSampleOptions(Command& command, SampleOptions& samples) {
  command.preset(
      "--as-in-paper", [&samples] { samples = SampleOptions::yguel2009(); },
      "sample the Gaussians as in Yguel et al. 2009");
  command.number("--samples", samples.samples, 1, 100000000,
                 "number of samples per scale, divided among its Gaussians");
  command.number("--at-least", samples.at_least, 0, 1000000, "minimum number of samples per Gaussian").rare();
  command
      .choiceOf("--sampling", samples.share, kShares,
                "samples per Gaussian: in proportion to its volume, or to its weight (mass)")
      .rare();
  command
      .choiceOf("--samples-in", samples.bounds, kBounds,
                R"(where samples of a Gaussian may lie: in the box of the finest cells that it represents (members),
                or anywhere in its cell, as in the paper (cell))")
      .rare();
  command.seed(samples.seed, "seed of the samples").rare();
}

}  // namespace

void addHausdorff(CLI::App& app) {
  auto options = std::make_shared<HausdorffCommand>();
  Command command(app, "hausdorff", kHausdorffHelp);
  command
      .text("subject", options->subject,
            "map (.gmap, or PCD of Gaussians), or a cloud (of any kind that pcd2map reads) or directory")
      .required();
  command
      .texts("reference", options->reference.paths,
             "clouds or directories of them, or one mesh (PLY with faces), or one map")
      .required();
  const Option scale = command.scale(options->scale, "compare only this scale, 0 = finest; default: all scales");
  command.flag("--leaves", options->leaves, "compare all leaves of a compressed map at once").excludes(scale);
  addSampleOptions(command, options->samples);
  command.flag("--max-only", options->max_only, "compute only the maxima; for two clouds; faster");
  command.flag("--check", options->check, "check all distances with the kd-tree of FLANN").rare();
  command.flag("--held-out", options->held_out,
               "compute the mean log-likelihood of the reference points under the map");
  command
      .number("--background", options->scoring.background, 1e-12, 0.999999,
              "for --held-out: share of points that may come from anywhere")
      .rare();
  command.text("--write-errors", options->errors.path, "PCD file to write: the points, coloured by their distance");
  command
      .choice("--direction", options->direction, {"forward", "backward"},
              "for --write-errors: forward = samples of the map, or points of the cloud; backward = reference")
      .rare();
  command.force(options->errors.force, "replace an existing file of errors");
  addScanOptions(command, options->reference);
  addSlice(command, options->slice);
  command.threads(options->samples.threads);
  command.json(options->json);
  std::vector<std::string> endings = scanEndings();
  endings.emplace_back(".gmap");
  command.files({"subject", "reference"}, endings);
  command.files({"--write-errors"}, {".pcd"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
