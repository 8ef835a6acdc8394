// SPDX-License-Identifier: BSD-3-Clause
// gaussmap crop MAP -o OUT --box|--polygon: a part of a map.
#include "gaussmap/editing/crop.h"

#include <iostream>
#include <limits>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct CropCommand {
  std::string map;
  Output output;
  std::vector<double> box;      // x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1 [m]
  std::vector<double> polygon;  // x y x y ... [m]
  bool outside = false, json = false;
};

Box<3> boxOf(const std::vector<double>& n) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (n.size() != 4 && n.size() != 6)
    throw UsageError("--box: takes x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1, not " + std::to_string(n.size()) + " numbers");
  Box<3> box =
      n.size() == 4 ? Box<3>{{n[0], n[1], -kFar}, {n[2], n[3], kFar}} : Box<3>{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
  if (!(box.low.array() < box.high.array()).all())
    throw UsageError("--box: takes the low corner first, and is not flat");
  return box;
}

Polygon polygonOf(const std::vector<double>& n) {
  if (n.size() % 2 != 0 || n.size() < 6)
    throw UsageError("--polygon: takes x y of three corners at least, not " + std::to_string(n.size()) + " numbers");
  std::vector<Vector<2>> corners;
  for (std::size_t i = 0; i < n.size(); i += 2) corners.emplace_back(n[i], n[i + 1]);
  return Polygon(std::move(corners));
}

std::function<bool(const Vector<3>&)> region(const CropCommand& options) {
  if (!options.box.empty())
    return [box = boxOf(options.box), outside = options.outside](const Vector<3>& p) {
      return isInBox<3>(box, p) != outside;
    };
  return [polygon = polygonOf(options.polygon), outside = options.outside](const Vector<3>& p) {
    return polygon.contains(p.x(), p.y()) != outside;
  };
}

void run(const CropCommand& options) {
  checkMapOutput(options.output, {options.map});
  if (options.box.empty() == options.polygon.empty()) throw UsageError("crop needs one of --box and --polygon");
  const auto isInside = region(options);
  const double start = now();
  MapMetadata metadata;
  const GaussianMap<3> whole = loadAnyMap(options.map, &metadata);
  const GaussianMap<3> map = crop<3>(whole, isInside);
  if (map.empty()) throw std::runtime_error(options.map + ": nothing of it lies in this region");

  metadata.erase("error_curves");  // of the whole
  Json step = {{"command", "crop"}, {"version", GAUSSMAP_VERSION}, {"outside", options.outside}};
  step[options.box.empty() ? "polygon" : "box"] = options.box.empty() ? options.polygon : options.box;
  addHistory(metadata, step);
  saveMap<3>(map, options.output.path, metadata, {options.output.force});
  reportMap(options.output.path, map, perScale(map, whole), start, options.json);
}

}  // namespace

void addCrop(CLI::App& app) {
  auto options = std::make_shared<CropCommand>();
  CLI::App* command = app.add_subcommand("crop", "Cut a part out of a map");
  command->footer(
      "What stays, stays as it was, exact moments too: parts that share nothing merge to the whole again. A Gaussian\n"
      "lies where its mean does; of a coarse cluster on the border stays what of it lies inside.\n"
      "Example: gaussmap crop town.gmap -o square.gmap --polygon 0 0 40 5 38 52 -3 45");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  command->add_option("--box", options->box, "x0 y0 x1 y1, or x0 y0 z0 x1 y1 z1 [m]: low corner <= mean < high corner")
      ->expected(4, 6)
      ->check(numberBetween(-1e12, 1e12));
  command->add_option("--polygon", options->polygon, "x y of its corners, in order [m], any height")
      ->expected(6, 1000000)
      ->check(numberBetween(-1e12, 1e12));
  command->add_flag("--outside", options->outside, "what lies outside stays instead");
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
