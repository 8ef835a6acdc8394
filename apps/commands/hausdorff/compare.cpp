// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>

#include "commands/hausdorff/check_distances.h"
#include "commands/hausdorff/hausdorff.h"
#include "commands/recordings.h"
#include "evaluation/error_cloud.h"
#include "gaussmap/io/mesh/ply.h"

namespace gaussmap::app {
using namespace detail;

namespace {

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

std::vector<Vector<3>> readSubject(const HausdorffCommand& command) {
  ScanInput cloud = command.reference;  // copies --frame, the ranges and --crop
  cloud.paths = {command.subject};
  cloud.poses.clear();
  if (recordingsIn(cloud.paths).empty()) cloud.files.recording = {};
  return readPoints(cloud, command.samples.threads);
}

Json writeErrors(const HausdorffCommand& command, const std::vector<Vector<3>>& reference,
                 const PointDistances& distances) {
  const bool forward = command.direction == "forward";
  const std::vector<Vector<3>>& points = forward ? distances.subject : reference;
  writeErrorCloud(command.errors.path, points, forward ? distances.forward : distances.backward);
  if (!command.json) std::cout << command.errors.path << ": " << points.size() << " points\n";
  return {{"file", command.errors.path}, {"direction", command.direction}, {"points", points.size()}};
}

/// Adds the result of --check to the report, or prints it.
void reportCheck(const HausdorffCommand& command, std::size_t checked, Json& json) {
  if (command.json)
    json["checked"] = checked;
  else
    std::printf("check: FLANN finds the same %zu distances\n", checked);
}

Reference readMesh(const HausdorffCommand& command) {
  return Reference(readPly(command.onlyReference()), command.samples.samples, command.samples.seed);
}

}  // namespace

template <int D>
void compareMap(const HausdorffCommand& command, ReferenceKind kind) {
  if (D == 2 && kind == ReferenceKind::Mesh)
    throw UsageError(command.onlyReference() + ": a planar map cannot be compared with a mesh, which has heights; " +
                     "compare it with scans (3-D scans need --slice Z0 Z1)");
  if (kind != ReferenceKind::Cloud && !command.slice.empty()) throw UsageError("--slice: only for scans");
  std::optional<Reference> reference;
  std::optional<GaussianMap<D>> other;
  if (kind == ReferenceKind::Map)
    other = loadMap<D>(command.onlyReference());
  else if (kind == ReferenceKind::Mesh)
    reference = readMesh(command);
  const GaussianMap<D> map = loadMap<D>(command.subject);
  if (!other && !reference) reference = Reference(readReference<D>(command, map.grid().side(0)));
  std::vector<const GaussianMap<D>*> maps = {&map};
  if (other) maps.push_back(&*other);
  const std::vector<Level> levels = chosenLevels<D>(command, maps);
  if (!command.errors.path.empty() && levels.size() > 1)
    throw UsageError("--write-errors: writes one cloud; choose a --scale or --leaves");

  Json all = Json::array(), written;
  std::size_t checked = 0;
  if (!command.json) printHead();
  for (const Level& level : levels) {
    const SampleOptions& samples = command.samples;
    if (other) reference = Reference(level ? sampleMap<D>(*other, *level, samples) : sampleLeaves<D>(*other, samples));
    PointDistances distances;
    const MapHausdorff result = level ? reference->compare(map, *level, samples, &distances)
                                      : reference->compareLeaves(map, samples, &distances);
    if (command.check) checked += checkDistances(reference->points(), distances, samples.threads);
    all.push_back({{"scale", jsonOf(level)},
                   {"gaussians", result.gaussians},
                   {"samples", result.samples},
                   {"unplaced", result.unplaced},
                   {"all", jsonOf(result.all)},
                   {"within_two_sigma", jsonOf(result.within_two_sigma)}});
    if (!command.json) {
      printRows(textOf(level), "all", "map", "ref", result.all);
      printRows(textOf(level), "2 sigma", "map", "ref", result.within_two_sigma);
    }
    if (!command.errors.path.empty()) written = writeErrors(command, reference->points(), distances);
  }
  Json json = {{"map", command.subject}, {"scales", all}};
  if (command.check) reportCheck(command, checked, json);
  if (!command.json) return;
  if (!written.is_null()) json["errors"] = written;
  printJson(json);
}
template void compareMap<2>(const HausdorffCommand&, ReferenceKind);
template void compareMap<3>(const HausdorffCommand&, ReferenceKind);

void compareCloud(const HausdorffCommand& command, ReferenceKind kind) {
  const int threads = command.samples.threads;
  PointDistances distances, *const wanted = command.errors.path.empty() && !command.check ? nullptr : &distances;
  HausdorffResult result;
  std::vector<Vector<3>> points;
  if (kind == ReferenceKind::Cloud) {
    points = readPoints(command.reference, threads);
    result = hausdorff(readSubject(command), points, threads, wanted);
  } else {
    const Reference mesh = readMesh(command);
    points = mesh.points();
    result = mesh.compare(readSubject(command), threads, wanted);
  }
  if (!command.json) {
    printHead();
    printRows("-", "points", "cloud", "ref", result);
  }
  Json json = {{"cloud", command.subject}, {"all", jsonOf(result)}};
  if (command.check) reportCheck(command, checkDistances(points, distances, threads), json);
  if (!command.errors.path.empty()) json["errors"] = writeErrors(command, points, distances);
  if (command.json) printJson(json);
}

void compareMaxima(const HausdorffCommand& command) {
  const std::vector<Vector<3>> reference = readPoints(command.reference, command.samples.threads);
  const std::vector<Vector<3>> subject = readSubject(command);
  const HausdorffMaxima maxima = hausdorffMaxima(subject, reference, command.samples.threads);
  Json json = {{"cloud", command.subject},
               {"all",
                {{"forward", {{"max", maxima.forward}}},
                 {"backward", {{"max", maxima.backward}}},
                 {"hausdorff", maxima.hausdorff()}}}};
  if (!command.json)
    std::printf("%-10s %10s\n%-10s %10.4g\n%-10s %10.4g\n", "direction", "max", "cloud->ref", maxima.forward,
                "ref->cloud", maxima.backward);
  if (command.check) reportCheck(command, checkMaxima(subject, reference, maxima, command.samples.threads), json);
  if (command.json) printJson(json);
}

}  // namespace gaussmap::app
