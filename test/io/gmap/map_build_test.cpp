// SPDX-License-Identifier: BSD-3-Clause
// Map files built within limited memory.
#include <algorithm>
#include <functional>
#include <numeric>

#include "clustering/merge_gains.h"
#include "gaussmap/io/gmap/build_map_file.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "io/gmap/largest_gains.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
using namespace detail;

namespace {

namespace fs = std::filesystem;

class BuiltFile : public MapFile {
 protected:
  fs::path path() const { return directory_.path() / "map.gmap"; }

  /// Scans of these points, in the map frame.
  std::vector<FileScan> scansOf(const std::vector<Vector<3>>& points, std::size_t scans) {
    std::vector<FileScan> sources;
    for (std::size_t i = 0; i < scans; ++i) {
      std::vector<Vector<3>> some;
      for (std::size_t j = i; j < points.size(); j += scans) some.push_back(points[j]);  // each is spread over all
      sources.push_back({directory_.path() / ("scan" + std::to_string(i) + ".pcd"), {}});
      writePcd(sources.back().path, some, PcdPrecision::Double);
    }
    return sources;
  }

  /// The same bytes as by way of memory?
  void expectSameFile(const std::vector<Vector<3>>& points, const MapOptions& map, double budget,
                      std::size_t max_memory = kMinBuildMemory, int threads = 0) {
    const std::vector<FileScan> scans = scansOf(points, 7);
    AccumulateOptions reading;
    reading.resolution = map.resolution;
    const MapMetadata metadata = {{"history", "[]"}};
    const fs::path expected = directory_.path() / "expected.gmap";
    save(expected,
         refine<3>(build<3>(accumulateScans(FileScans(scans, ScanFrame::Map), reading).moments, map), PerCell{budget})
             .map,
         metadata, {true, 3, 0});
    BuildMapFileOptions options;
    options.max_memory = max_memory;
    options.budget = PerCell{budget};
    options.refine.threads = reading.threads = threads;
    options.save = {true, 3, threads};
    const BuiltMapFile built = buildMapFile(
        FileScans(scans, ScanFrame::Map), reading, map, path(), [&](const PointCounts&) { return metadata; }, options);
    EXPECT_EQ(built.counts.accepted, static_cast<std::int64_t>(points.size()));
    const GaussianMapOctree loaded = load(path());
    for (int s = 0; s < loaded.scales(); ++s) {
      EXPECT_EQ(built.cells[static_cast<std::size_t>(s)], loaded.cellCount(s));
      EXPECT_EQ(built.gaussians[static_cast<std::size_t>(s)], loaded.gaussianCount(s));
    }
    expectSameMap<3>(loaded, load(expected));
    EXPECT_TRUE(contentsOf(path()) == contentsOf(expected));
  }
};

TEST_F(BuiltFile, HasTheBytesOfTheMapBuiltInMemory) {
  const auto points = randomCloud<3>(30000, 151);
  for (const double budget : {1.0, 1.7, 3.0, 50.0}) expectSameFile(points, {0.02, 5, 3, 0.0}, budget);
  expectSameFile(points, {0.01, 2, 8, 0.0}, 2.0);
  expectSameFile(points, {0.03, 10, 3, 0.002}, 2.5);
  expectSameFile(points, {0.02, 10, 1, 0.0}, 3.0);
}

TEST_F(BuiltFile, HasTheSameBytesForAnyMemoryAndThreads) {
  const auto points = randomCloud<3>(60000, 152);
  for (const std::size_t megabytes : {1, 3, 10, 100}) expectSameFile(points, {0.01, 5, 3, 0.0}, 2.0, megabytes << 20);
  for (const int threads : {1, 2}) expectSameFile(points, {0.01, 5, 3, 0.0}, 2.0, 2 << 20, threads);
}

TEST_F(BuiltFile, BreaksTiesAsInMemory) {  // equal cells all over: which of them get more Gaussians?
  std::vector<Vector<3>> points;
  for (int x = -60; x < 60; ++x)
    for (int y = -60; y < 60; ++y) points.emplace_back(x + 0.5, y + 0.5, 0.5);
  for (const double budget : {1.3, 2.0, 3.7}) {
    expectSameFile(points, {1.0, 4, 3, 0.0}, budget);
    expectSameFile(points, {1.0, 2, 6, 0.0}, budget);
  }
}

TEST_F(BuiltFile, HoldsPointsFarApartAndNone) {
  expectSameFile({{0, 0, 1}, {1e7, -1e7, 3}, {2e8, -2e8, 2e8}, {1e7, -1e7, 3.01}}, {0.1, 10, 3, 0.0}, 3.0);
  expectSameFile({{1, 2, 3}}, {0.1, 5, 4, 0.0}, 3.0);
  expectSameFile({}, {0.1, 5, 4, 0.0}, 3.0);
}

TEST_F(BuiltFile, LeavesNothingBehind) {
  const auto points = randomCloud<3>(100, 153);
  const std::vector<FileScan> scans = scansOf(points, 1);
  AccumulateOptions reading;
  const MapOptions map{0.1, 5, 3, 0.0};
  const auto attempt = [&](const AccumulateOptions& how, const BuildMapFileOptions& options, bool refuse = false) {
    buildMapFile(
        FileScans(scans, ScanFrame::Map), how, map, path(),
        [&](const PointCounts&) {
          if (refuse) throw std::runtime_error("no");
          return MapMetadata();
        },
        options);
  };
  BuildMapFileOptions insert, little, finished, low, bytes, curves;
  insert.refine.method = RefineMethod::Insert;
  EXPECT_THROW(attempt(reading, insert), std::invalid_argument);
  little.max_memory = kMinBuildMemory - 1;
  EXPECT_THROW(attempt(reading, little), std::invalid_argument);
  finished.save.precision = Precision::Finished;
  EXPECT_THROW(attempt(reading, finished), std::invalid_argument);
  low.budget = PerCell{0.5};
  EXPECT_THROW(attempt(reading, low), std::invalid_argument);
  bytes.budget = maxFileBytes(100000);
  EXPECT_THROW(attempt(reading, bytes), std::invalid_argument);
  curves.refine.curves.emplace();
  EXPECT_THROW(attempt(reading, curves), std::invalid_argument);
  AccumulateOptions other = reading;
  other.resolution = 0.2;
  EXPECT_THROW(attempt(other, {}), std::invalid_argument);
  EXPECT_THROW(attempt(reading, {}, true), std::runtime_error);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"scan0.pcd"});
  attempt(reading, {});
  EXPECT_THROW(attempt(reading, {}), FileError);  // it exists
  EXPECT_EQ(namesInFolder(), (std::vector<std::string>{"map.gmap", "scan0.pcd"}));
}

TEST(LargestGains, AreThoseOfAQueue) {
  Random random(154);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::vector<double>> cells(1 + random.below(20));
    std::vector<double> all;
    for (std::vector<double>& gains : cells) {
      for (std::uint64_t i = random.below(8); i > 0; --i)
        gains.push_back(round % 2 ? random.normal() : double(random.below(4)) - 1.0);  // many ties; both signs; zero
      if (random.below(3) == 0 && !gains.empty()) gains[0] = -0.0;
      std::sort(gains.begin(), gains.end(), std::greater<>());
      all.insert(all.end(), gains.begin(), gains.end());
    }
    for (std::size_t count = 0; count <= all.size() + 2; ++count) {
      const GainThreshold threshold = largestGains(count, [&](const std::function<void(double)>& visit) {
        for (const double gain : all) visit(gain);
      });
      std::size_t left = threshold.ties;
      std::vector<std::size_t> parts;
      for (const std::vector<double>& gains : cells) {
        std::size_t taken = 0;
        for (const double gain : gains) {
          const bool tie = gain == threshold.gain && left > 0;
          taken += gain > threshold.gain || tie;
          left -= tie;
        }
        parts.push_back(1 + taken);
      }
      EXPECT_EQ(parts, partsPerCell(cells, count)) << "round " << round << ", " << count;
    }
  }
}

}  // namespace
}  // namespace gaussmap::test
