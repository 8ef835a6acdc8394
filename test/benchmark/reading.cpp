// SPDX-License-Identifier: BSD-3-Clause
#include <pcl/io/pcd_io.h>

#include <array>
#include <stdexcept>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "measure.h"
#include "parts.h"

namespace gaussmap::benchmark {
namespace {

/// Reads every coordinate, block by block, and keeps nothing. Maps are built from files in this way.
double blocks(const std::string& path) {
  const PcdReader reader(path);
  PointBlock<3> block;
  double sum = 0.0;
  for (std::size_t first = 0; first < reader.size(); first += block.kCapacity) {
    reader.read(first, block);
    for (std::size_t i = 0; i < block.size; ++i)
      sum += block.coordinate[0][i] + block.coordinate[1][i] + block.coordinate[2][i];
  }
  return sum != 0.0 ? static_cast<double>(reader.size()) : 0.0;
}

/// Reads the coordinates of all points into memory with the same layout as PCL's.
double whole(const std::string& path) {
  const PcdReader reader(path);
  std::vector<std::array<float, 4>> points(reader.size());
  PointBlock<3> block;
  for (std::size_t first = 0; first < reader.size(); first += block.kCapacity) {
    reader.read(first, block);
    for (std::size_t i = 0; i < block.size; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        points[first + i][axis] = static_cast<float>(block.coordinate[axis][i]);
  }
  return static_cast<double>(points.size());
}

double pcls(const std::string& path) {
  Cloud cloud;
  if (pcl::io::loadPCDFile(path, cloud) != 0) throw std::runtime_error(path + ": PCL cannot read it");
  return static_cast<double>(cloud.size());
}

}  // namespace

void measureReading(const Cloud& cloud, const std::filesystem::path& work, int runs, Table& table) {
  const std::string binary = work / "binary.pcd", compressed = work / "compressed.pcd", ascii = work / "ascii.pcd";
  pcl::io::savePCDFileBinary(binary, cloud);
  pcl::io::savePCDFileBinaryCompressed(compressed, cloud);
  pcl::io::savePCDFileASCII(ascii, cloud);
  for (const std::string& path : {binary, compressed, ascii}) {
    const std::vector<Measured> of =
        measureInTurn({[&, file = path] { return blocks(file); }, [&, file = path] { return whole(file); },
                       [&, file = path] { return pcls(file); }},
                      runs);
    if (of[0].value != of[2].value || of[1].value != of[2].value)
      throw std::runtime_error(path + ": the readers differ");
    const std::string input =
        std::filesystem::path(path).stem().string() + ", " + std::to_string(cloud.size()) + " points";
    const auto row = [&](const char* part, const Measured& measured) {
      table.add(Row{part, input, 1, measured.seconds, measured.megabytes, "pcl::io::loadPCDFile", of[2].seconds,
                    of[2].megabytes});
    };
    row("reading PCD by blocks", of[0]);
    row("reading PCD into memory", of[1]);
  }
}

}  // namespace gaussmap::benchmark
