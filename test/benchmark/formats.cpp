// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark formats FILE...: how fast the same scans are read from files of many kinds, beside PCL and PCD
// files. All times are of one thread and include opening. The files are in the cache of the operating system.
#include <pcl/io/pcd_io.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "clock.h"
#include "gaussmap/io/scans/file_scans.h"
#include "io/files/temporary_directory.h"
#include "io/scans/open_scan_file.h"
#include "measure.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

using IntensityCloud = pcl::PointCloud<pcl::PointXYZI>;

/// What was read: so that nothing is optimised away, and to compare the readers.
struct Sums {
  std::size_t points = 0;
  Eigen::Vector3d coordinates = Eigen::Vector3d::Zero();
};

/// One way to read the scans.
struct Way {
  std::string name;
  std::vector<FileScan> scans;  // of gaussmap
  std::vector<std::string> paths;
  std::function<Sums()> read;
  Sums sums;
  double megabytes = 0.0;  // peak of a process of its own
  std::vector<double> processor, wall;

  double fileMegabytes() const {
    double sum = 0.0;
    for (const std::string& path : paths) sum += static_cast<double>(std::filesystem::file_size(path)) / 1e6;
    return sum;
  }
};

struct Given {
  std::vector<std::string> files;
  int runs = 15;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

Sums readByBlocks(const Way& way) {
  const FileScans scans(way.scans);
  Sums sums;
  PointBlock<3> block;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::unique_ptr<ScanReader> reader = scans.open(i);
    for (std::size_t first = 0; first < reader->size(); first += block.size) {
      reader->read(first, block);
      for (int axis = 0; axis < 3; ++axis)
        sums.coordinates[axis] +=
            Eigen::Map<const Eigen::ArrayXd>(block.coordinate[axis], static_cast<Eigen::Index>(block.size)).sum();
    }
    sums.points += reader->size();
    reader->requireWhole();
  }
  return sums;
}

/// Reads as a program with PCL does: one cloud after the other. Only one coordinate of each cloud is used.
Sums readWithPcl(const std::vector<std::string>& paths) {
  Sums sums;
  for (const std::string& path : paths) {
    IntensityCloud cloud;
    if (pcl::io::loadPCDFile(path, cloud) != 0) throw std::runtime_error(path + ": PCL cannot read it");
    sums.points += cloud.size();
    if (!cloud.empty()) sums.coordinates += cloud.back().getVector3fMap().cast<double>();
  }
  return sums;
}

/// Sorts the files by kind.
std::vector<Way> waysOf(const std::vector<std::string>& files) {
  std::vector<Way> ways;
  for (const std::string& path : files) {
    const auto file = detail::openScanFile(path, {{}, false, {}});
    const std::string name = file->kind().substr(0, file->kind().find(','));
    auto way = std::find_if(ways.begin(), ways.end(), [&](const Way& one) { return one.name == name; });
    if (way == ways.end()) {
      way = ways.emplace(ways.end());
      way->name = name;
    }
    way->paths.push_back(path);
    for (std::size_t i = 0; i < file->size(); ++i) way->scans.push_back({path, Pose(), {}, i, file->info(i).name});
  }
  return ways;
}

/// Writes the scans of the first kind with PCL, binary and compressed.
void addPcl(const std::filesystem::path& folder, std::vector<Way>& ways) {
  Way binary, compressed;
  binary.name = "PCL: PCD binary";
  compressed.name = "PCL: PCD binary_compressed";
  const FileScans scans(ways.at(0).scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::unique_ptr<ScanReader> reader = scans.open(i);
    IntensityCloud cloud;
    cloud.resize(reader->size());
    PointBlock<3> block;
    for (std::size_t first = 0; first < reader->size(); first += block.size) {
      reader->read(first, block);
      for (std::size_t k = 0; k < block.size; ++k)
        for (int axis = 0; axis < 3; ++axis)
          cloud[first + k].data[axis] = static_cast<float>(block.coordinate[axis][k]);
    }
    const std::vector<std::string> names = reader->valueNames();
    if (std::find(names.begin(), names.end(), "intensity") != names.end()) {
      const std::vector<double> values = reader->values("intensity");
      for (std::size_t k = 0; k < values.size(); ++k) cloud[k].intensity = static_cast<float>(values[k]);
    }
    binary.paths.push_back(folder / ("binary" + std::to_string(i) + ".pcd"));
    compressed.paths.push_back(folder / ("compressed" + std::to_string(i) + ".pcd"));
    pcl::io::savePCDFileBinary(binary.paths.back(), cloud);
    pcl::io::savePCDFileBinaryCompressed(compressed.paths.back(), cloud);
  }
  std::vector<std::string> written = binary.paths;
  written.insert(written.end(), compressed.paths.begin(), compressed.paths.end());
  std::vector<Way> own = waysOf(written);
  for (Way& way : own) way.name += ", written by PCL";
  ways.insert(ways.begin(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  ways.insert(ways.begin(), {binary, compressed});
}

void requireSamePoints(const Sums& sums, const Way& way, const std::string& other) {
  constexpr double kTolerance = 1e-3;  // [m], because LAS files have steps
  if (sums.points != way.sums.points)
    throw std::runtime_error(way.name + " has " + std::to_string(way.sums.points) + " points, " + other + " has " +
                             std::to_string(sums.points));
  const double difference = (sums.coordinates - way.sums.coordinates).norm() / static_cast<double>(sums.points);
  if (!(difference < kTolerance))
    throw std::runtime_error(way.name + ": the mean point is " + std::to_string(difference) + " m from that of " +
                             other);
}

void measureInRounds(int runs, std::vector<Way>& ways) {
  std::vector<std::size_t> order(ways.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(1);
  for (int run = 0; run < runs; ++run) {
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t w : order) {
      const double wall = wallSeconds(), processor = processorSeconds();
      ways[w].read();
      ways[w].processor.push_back(processorSeconds() - processor);
      ways[w].wall.push_back(wallSeconds() - wall);
    }
  }
}

void print(const std::vector<Way>& ways, int runs) {
  std::printf(
      "%zu points in %zu scans. Medians of %d interleaved runs after a first one, with opening, one thread. Rates and\n"
      "ratios are of processor time: how many times faster than PCL. Memory: peak of a process of its own.\n",
      ways.at(2).sums.points, ways.at(2).scans.size(), runs);
  std::printf("%-42s %8s %9s %8s %8s %9s %8s %8s %9s\n", "", "", "processor", "wall", "", "", "PCL", "PCL", "memory");
  std::printf("%-42s %8s %9s %8s %8s %9s %8s %8s %9s\n", "kind", "MB", "ms", "ms", "MB/s", "Mpoint/s", "binary",
              "compr.", "MB");
  const double binary = median(ways[0].processor), compressed = median(ways[1].processor);
  for (const Way& way : ways) {
    const double seconds = median(way.processor);
    std::printf("%-42s %8.1f %9.2f %8.2f %8.0f %9.1f %8.2f %8.2f %9.1f\n", way.name.c_str(), way.fileMegabytes(),
                1e3 * seconds, 1e3 * median(way.wall), way.fileMegabytes() / seconds,
                1e-6 * static_cast<double>(ways[2].sums.points) / seconds, binary / seconds, compressed / seconds,
                way.megabytes);
  }
}

void runFormats(const Given& given) {
  const test::TemporaryDirectory folder;
  std::vector<Way> ways = waysOf(given.files);
  addPcl(folder.path(), ways);
  for (std::size_t i = 0; i < ways.size(); ++i) {
    Way& way = ways[i];
    if (i < 2)
      way.read = [&way] { return readWithPcl(way.paths); };
    else
      way.read = [&way] { return readByBlocks(way); };
    const auto alone = [&way] { return static_cast<double>(way.read().points); };
    way.megabytes = measureInTurn({alone}, 1)[0].megabytes;
  }
  for (Way& way : ways) way.sums = way.read();
  for (std::size_t i = 3; i < ways.size(); ++i) requireSamePoints(ways[2].sums, ways[i], ways[2].name);
  for (std::size_t i = 0; i < 2; ++i)
    if (ways[i].sums.points != ways[2].sums.points) throw std::runtime_error(ways[i].name + ": PCL reads other points");
  measureInRounds(given.runs, ways);
  print(ways, given.runs);
}

}  // namespace

void addFormats(CLI::App& app) {
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("formats", "how fast the same scans are read from files of many kinds");
  command.add_option("files", given->files, "the same scans in files of any kinds")->required();
  command.add_option("--runs", given->runs, "number of runs")->check(CLI::PositiveNumber)->capture_default_str();
  command.callback([given] { runFormats(*given); });
}

}  // namespace gaussmap::benchmark
