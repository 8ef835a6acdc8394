// SPDX-License-Identifier: BSD-3-Clause
// gaussmap crop MAP -o OUT --box|--polygon: cuts a part out of a map.
#include "gaussmap/editing/crop.h"

#include <memory>
#include <stdexcept>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/box.h"
#include "common/command.h"

namespace gaussmap::app {
namespace {

struct CropCommand : MapTaskOptions {
  std::vector<double> box;      // x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1 [m]
  std::vector<double> polygon;  // x y x y ... [m]
  bool outside = false;
};

const Help kCropHelp = {
    "Cut a part out of a map", "gaussmap crop town.gmap -o square.gmap --polygon 0 0 40 5 38 52 -3 45",
    R"(A Gaussian is inside if its mean is inside. Gaussians inside stay unchanged, including their exact moments, so
parts that do not overlap can be merged to the whole map again. A coarse cluster on the border is recomputed from
the Gaussians inside.)"};

Polygon polygonOf(const std::vector<double>& n) {
  if (n.size() % 2 != 0 || n.size() < 6)
    throw UsageError("--polygon: " + std::to_string(n.size()) +
                     " numbers found, expected x y of at least three corners");
  std::vector<Vector<2>> corners;
  for (std::size_t i = 0; i < n.size(); i += 2) corners.emplace_back(n[i], n[i + 1]);
  return Polygon(std::move(corners));
}

template <int D>
std::function<bool(const Vector<D>&)> region(const CropCommand& command) {
  if (!command.box.empty())
    return [box = mapBoxOf<D>("--box", command.box), outside = command.outside](const Vector<D>& p) {
      return isInBox<D>(box, p) != outside;
    };
  return [polygon = polygonOf(command.polygon), outside = command.outside](const Vector<D>& p) {
    return polygon.contains(p.x(), p.y()) != outside;
  };
}

template <int D>
void run(const CropCommand& command) {
  MapTask task(command);
  if (command.box.empty() == command.polygon.empty()) throw UsageError("crop needs one of --box and --polygon");
  const auto isInside = region<D>(command);
  const GaussianMap<D> whole = task.load<D>();
  const GaussianMap<D> map = crop<D>(whole, isInside);
  if (map.empty()) throw std::runtime_error(command.map + ": no Gaussian lies in this region");
  Json step = {{"outside", command.outside}};
  step[command.box.empty() ? "polygon" : "box"] = command.box.empty() ? command.polygon : command.box;
  task.addStep("crop", step);
  task.save(map);
  task.report(map, whole);
}

}  // namespace

void addCrop(CLI::App& app) {
  auto options = std::make_shared<CropCommand>();
  Command command(app, "crop", kCropHelp);
  addMapToMap(command, *options);
  command.numbers("--box", options->box, 4, 6, -1e12, 1e12,
                  "x0 y0 x1 y1, or (not for planar maps) x0 y0 z0 x1 y1 z1 [m]: low corner <= mean < high corner");
  command.numbers("--polygon", options->polygon, 6, 1000000, -1e12, 1e12,
                  "x y of the corners, in order [m]; all heights are inside");
  command.flag("--outside", options->outside, "keep the Gaussians outside instead");
  command.json(options->json);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
