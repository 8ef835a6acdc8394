// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <stdexcept>

#include "gaussmap/io/pcd/pcd_writer.h"
#include "measure.h"
#include "parts.h"
#include "street_points.h"

namespace gaussmap::benchmark {
namespace {

using Command = std::vector<std::string>;

bool isInstalled(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

void compare(const std::string& part, const std::string& input, const std::vector<Command>& commands, int runs,
             Table& table) {  // commands: gaussmap with one thread, with two, the peer
  const std::vector<Measured> of = measureCommandsInTurn(commands, runs);
  for (int threads = 1; threads <= 2; ++threads) {
    const Measured& own = of[static_cast<std::size_t>(threads) - 1];
    table.add(Row{part, input, threads, own.seconds, own.megabytes, commands.back().front(), of.back().seconds,
                  of.back().megabytes});
  }
}

}  // namespace

void measureCommands(const Options& options, const std::filesystem::path& work, Table& table) {
  if (!isInstalled("pcl_voxel_grid") || !isInstalled("pcl_compute_hausdorff")) {
    std::printf("whole commands: pcl-tools is not installed\n");
    return;
  }
  const std::string gaussmap = std::filesystem::path(options.build) / "apps" / "gaussmap";
  const std::size_t points = options.points.front();
  const std::string cloud = work / "drive.pcd";
  writePcd(cloud, streetPoints(points, 0, 1));
  for (const std::string leaf : {"0.1", "0.2", "1"}) {
    const auto map = [&](const char* threads) {
      return Command{gaussmap,       "pcd2map", cloud,     "-o",  work / "map.gmap", "--force", "--budget", "1",
                     "--resolution", leaf,      "--frame", "map", "--threads",       threads};
    };
    compare("pcd2map, three scales", std::to_string(points) + " points, " + leaf + " m",
            {map("1"), map("2"), {"pcl_voxel_grid", cloud, work / "out.pcd", "-leaf", leaf + "," + leaf + "," + leaf}},
            options.runs, table);
  }
  const std::size_t fewer = std::min<std::size_t>(points, 1000000);
  const std::string a = work / "a.pcd", b = work / "b.pcd";
  writePcd(a, streetPoints(fewer, 0, 1));
  writePcd(b, streetPoints(fewer, 9, 1));
  const auto distance = [&](const char* threads) {
    return Command{gaussmap, "hausdorff", a, b, "--frame", "map", "--threads", threads};
  };
  compare("gaussmap hausdorff", std::to_string(fewer) + " points each",
          {distance("1"), distance("2"), {"pcl_compute_hausdorff", a, b}}, options.runs, table);
}

void runOthers(const Options& options, const std::filesystem::path& work, Table& table) {
  const std::string program = std::filesystem::canonical("/proc/self/exe");
  std::vector<Command> commands = {{program, "refinement-speed"},
                                   {program, "registration", "--starts", "3", "--basin", "3"},
                                   {program, "normals"},
                                   {program, "segments", "--only-speed"}};
  if (!options.data.empty()) {
    for (const std::size_t i : {std::size_t{1}, std::size_t{3}})
      commands[i].insert(commands[i].end(), {"--data", options.data});
    for (const char* cloud : {"kitti_6scans", "rgbd_office_single"}) commands[2].push_back(options.data + "/" + cloud);
  }
  for (Command& command : commands) {
    const std::string json = work / (command.at(1) + ".json");
    command.insert(command.end(), {"--json", json});
    measureCommandsInTurn({command}, 1);
    addJson(json, table);
  }
}

}  // namespace gaussmap::benchmark
