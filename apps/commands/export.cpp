// SPDX-License-Identifier: BSD-3-Clause
// gaussmap export MAP OUT: writes the Gaussians for other programs. The extension of OUT chooses the format.
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/export/map_export.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
namespace {

struct ExportCommand {
  std::string map;
  Output output;
  std::optional<int> scale;
  std::string content;  // empty: the default
  std::string colour;
  std::optional<double> sigma;
};

const Help kExportHelp = {"Write the Gaussians of a map for other programs: PCD, PLY, VTP, CSV",
                          "gaussmap export street.gmap street.ply --as splats --scale 1",
                          R"(The extension of the output chooses the format:
.pcd  Readable by all PCL tools and by gaussmap. Fields: x y z covariance[6] weight occupancy cell_side scale
      cell_x cell_y cell_z
.ply  --as ellipsoids for mesh viewers, points for point cloud viewers, splats for viewers of 3D Gaussian splatting.
      Without --scale, the leaves of the map. Coordinates are floats: if the header has a comment "origin X Y Z", add
      it to all coordinates.
.vtp  For ParaView: covariances and their square roots as tensors, normals, weights, occupancy, parents.
.csv  One line per Gaussian.
A planar map is written as flat Gaussians in the plane z = 0. Their standard deviation across it is the noise floor.)"};

const std::map<std::string, PlyContent> kContents = {
    {"ellipsoids", PlyContent::Ellipsoids}, {"points", PlyContent::Points}, {"splats", PlyContent::Splats}};
const std::map<std::string, PlyColour> kColours = {{"height", PlyColour::Height}, {"normal", PlyColour::Normal}};

GaussianPlyOptions plyOptions(const ExportCommand& options) {
  GaussianPlyOptions ply;
  ply.scale = options.scale;
  if (!options.content.empty()) ply.content = kContents.at(options.content);
  if (!options.colour.empty()) ply.colour = kColours.at(options.colour);
  ply.sigma = options.sigma.value_or(ply.sigma);
  return ply;
}

/// Throws UsageError for options of PLY files if the output is not a PLY file, and for --sigma without ellipsoids.
void checkPlyOptions(const ExportCommand& options, const std::string& ending) {
  if (ending != ".ply")
    for (const auto& [name, given] :
         {std::pair("--as", !options.content.empty()), std::pair("--color", !options.colour.empty()),
          std::pair("--sigma", options.sigma.has_value())})
      if (given) throw UsageError(std::string(name) + ": only for .ply files, not for " + options.output.path);
  if (options.sigma && plyOptions(options).content != PlyContent::Ellipsoids)
    throw UsageError("--sigma: only for ellipsoids, not for points and splats");
}

std::size_t write(const ExportCommand& options, const GaussianMap<3>& map, const std::string& ending) {
  const std::filesystem::path target = options.output.path;
  if (ending == ".csv") return saveCsv(target, map, options.scale);
  if (ending == ".vtp") return saveVtp(target, map, options.scale);
  if (ending == ".ply") return savePly(target, map, plyOptions(options));
  ExportOptions pcd;
  pcd.overwrite = options.output.force;
  pcd.scale = options.scale;
  savePcd(target, map, pcd);
  std::size_t count = 0;
  for (int s = 0; s < map.scales(); ++s) count += !options.scale || *options.scale == s ? map.gaussianCount(s) : 0;
  return count;
}

void run(const ExportCommand& options) {
  const std::string ending = endingOf(options.output.path);
  if (ending != ".pcd" && ending != ".ply" && ending != ".vtp" && ending != ".csv")
    throw UsageError(options.output.path + ": the name must end in .pcd, .ply, .vtp or .csv");
  checkPlyOptions(options, ending);
  checkOutput(options.output, {options.map});
  const GaussianMap<3> map = loadInSpace(options.map);
  if (options.scale) checkScale("--scale", *options.scale, map.scales());
  const std::size_t count = write(options, map, ending);
  std::cout << options.output.path << ": " << count << " Gaussians, "
            << humanBytes(std::filesystem::file_size(options.output.path)) << '\n';
}

}  // namespace

void addExport(CLI::App& app) {
  auto options = std::make_shared<ExportCommand>();
  Command command(app, "export", kExportHelp);
  command.map(options->map);
  command.text("output", options->output.path, "file to write (.pcd, .ply, .vtp, .csv)").required();
  command.force(options->output.force);
  command.scale(options->scale, "write only this scale, 0 = finest");
  command.choice("--as", options->content, {"ellipsoids", "points", "splats"},
                 "contents of a .ply: ellipsoids (default), points, splats");
  command.choice("--color", options->colour, {"height", "normal"}, "colours of a .ply: height (default), normal");
  command.number("--sigma", options->sigma, 0.01, 100.0,
                 "half axes of the ellipsoids of a .ply, in standard deviations; default 2");
  command.files({"output"}, {".pcd", ".ply", ".vtp", ".csv"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
