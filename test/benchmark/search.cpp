// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark search [DIR or PCD...] [--queries N] [--json FILE]: compares GaussianMapSearch with
// pcl::search::KdTree (FLANN) and pcl::search::Octree on clouds, and MapSearch and the queries without preparation with
// pcl::KdTreeFLANN on the means of maps. Every time is that of the construction and all queries. One thread.
#include <pcl/search/kdtree.h>
#include <pcl/search/octree.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "clouds.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/pcl/conversions.h"
#include "gaussmap/pcl/search.h"
#include "subcommands.h"

namespace gaussmap::benchmark {
namespace {

using SearchCloud = pcl::PointCloud<pcl::PointXYZ>;

/// The questions that all searches answer.
struct Questions {
  std::vector<pcl::PointXYZ> points;
  double radius = 0.0;  // [m]: about 20 neighbours
};

/// Processor times of one search [s], and sums of the distances [m] that show that the searches agree.
struct Times {
  std::string name;
  double build = 0.0, nearest = 0.0, ten = 0.0, within = 0.0;
  double nearest_sum = 0.0, ten_sum = 0.0;
  std::size_t found = 0;  // within the radius, in a set
};

constexpr int kNeighbours = 10;

Questions questionsFor(const SearchCloud& cloud, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  Questions questions;
  pcl::search::KdTree<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud.makeShared());
  pcl::Indices indices;
  std::vector<float> squares, of_twentieth;
  while (questions.points.size() < count) {  // points of the cloud, moved by about the distance of neighbours
    const pcl::PointXYZ& point = cloud[random.below(cloud.size())];
    if (!pcl::isFinite(point)) continue;
    tree.nearestKSearch(point, 20, indices, squares);
    of_twentieth.push_back(squares.back());
    const float spread = 0.5f * std::sqrt(squares.back());
    questions.points.emplace_back(point.x + spread * float(random.normal()), point.y + spread * float(random.normal()),
                                  point.z + spread * float(random.normal()));
  }
  std::sort(of_twentieth.begin(), of_twentieth.end());
  questions.radius = std::sqrt(double{of_twentieth[of_twentieth.size() / 2]});
  return questions;
}

/// Runs the parts of a search in turn with those of other searches, and keeps the fastest time of each part.
class Race {
 public:
  /// `run`: measures one search and returns its times.
  void add(std::function<Times()> run) { entrants_.push_back(std::move(run)); }

  std::vector<Times> run(int runs) const {
    std::vector<Times> best;
    for (int round = 0; round < runs; ++round)
      for (std::size_t i = 0; i < entrants_.size(); ++i) {
        const Times times = entrants_[i]();
        if (round == 0) {
          best.push_back(times);
          continue;
        }
        best[i].build = std::min(best[i].build, times.build);
        best[i].nearest = std::min(best[i].nearest, times.nearest);
        best[i].ten = std::min(best[i].ten, times.ten);
        best[i].within = std::min(best[i].within, times.within);
      }
    return best;
  }

 private:
  std::vector<std::function<Times()>> entrants_;
};

template <typename Work>
double secondsOf(const Work& work) {
  const double start = processorSeconds();
  work();
  return processorSeconds() - start;
}

double sumOf(const std::vector<float>& squares) {
  double sum = 0.0;
  for (const float square : squares) sum += std::sqrt(double{square});
  return sum;
}

/// Measures a search of PCL; `make` makes it without points.
template <typename Make>
Times timesOfPcl(const std::string& name, const SearchCloud::ConstPtr& cloud, const Questions& questions,
                 const Make& make) {
  Times times;
  times.name = name;
  pcl::Indices indices;
  std::vector<float> squares;
  const auto search = make();
  times.build = secondsOf([&] { search->setInputCloud(cloud); });
  times.nearest = secondsOf([&] {
    for (const auto& point : questions.points) {
      search->nearestKSearch(point, 1, indices, squares);
      times.nearest_sum += sumOf(squares);
    }
  });
  times.ten = secondsOf([&] {
    for (const auto& point : questions.points) {
      search->nearestKSearch(point, kNeighbours, indices, squares);
      times.ten_sum += sumOf(squares);
    }
  });
  times.within = secondsOf([&] {
    for (const auto& point : questions.points)
      times.found += std::size_t(search->radiusSearch(point, questions.radius, indices, squares));
  });
  return times;
}

double sumOf(const std::vector<FoundGaussian>& found) {
  double sum = 0.0;
  for (const FoundGaussian& each : found) sum += each.distance;
  return sum;
}

/// Measures searches for the means of a map. `nearest`, `ten` and `within` answer one question each.
template <typename Nearest, typename Ten, typename Within>
void askMap(const Questions& questions, Times& times, const Nearest& nearest, const Ten& ten, const Within& within) {
  times.nearest = secondsOf([&] {
    for (const auto& point : questions.points)
      times.nearest_sum += nearest(Vector<3>(point.getVector3fMap().cast<double>()));
  });
  times.ten = secondsOf([&] {
    for (const auto& point : questions.points)
      times.ten_sum += sumOf(ten(Vector<3>(point.getVector3fMap().cast<double>())));
  });
  times.within = secondsOf([&] {
    for (const auto& point : questions.points)
      times.found += within(Vector<3>(point.getVector3fMap().cast<double>())).size();
  });
}

Times timesOfMapSearch(const GaussianMapOctree& map, int scale, const Questions& questions) {
  Times times;
  times.name = "MapSearch";
  std::optional<MapSearch<3>> search;
  times.build = secondsOf([&] { search.emplace(map, scale); });
  askMap(
      questions, times, [&](const Vector<3>& point) { return search->nearest(point)->distance; },
      [&](const Vector<3>& point) { return search->nearestK(point, kNeighbours); },
      [&](const Vector<3>& point) { return search->within(point, questions.radius); });
  return times;
}

Times timesOfQueries(const GaussianMapOctree& map, int scale, const Questions& questions) {
  Times times;
  times.name = "queries of the map";
  askMap(
      questions, times, [&](const Vector<3>& point) { return nearest<3>(map, point, scale)->distance; },
      [&](const Vector<3>& point) { return nearestK<3>(map, point, kNeighbours, scale); },
      [&](const Vector<3>& point) { return within<3>(map, point, questions.radius, scale); });
  return times;
}

Race raceOnPoints(const SearchCloud::ConstPtr& cloud, const Questions& questions) {
  Race race;
  race.add([=] {
    return timesOfPcl("GaussianMapSearch", cloud, questions,
                      [] { return std::make_unique<GaussianMapSearch<pcl::PointXYZ>>(); });
  });
  race.add([=] {
    return timesOfPcl("pcl::search::KdTree", cloud, questions,
                      [] { return std::make_unique<pcl::search::KdTree<pcl::PointXYZ>>(); });
  });
  return race;
}

class SearchComparison {
 public:
  SearchComparison(int runs, std::size_t queries) : runs_(runs), queries_(queries) {}

  void compareCloud(const NamedCloud& input) {
    const Questions questions = questionsFor(*input.cloud, queries_, 1);
    Race race = raceOnPoints(input.cloud, questions);
    const double resolution = 2.0 * questions.radius;
    const SearchCloud::ConstPtr cloud = input.cloud;
    race.add([=] {
      return timesOfPcl("pcl::search::Octree", cloud, questions,
                        [=] { return std::make_unique<pcl::search::Octree<pcl::PointXYZ>>(resolution); });
    });
    print(input.name, "points", input.cloud->size(), questions, race.run(runs_));
  }

  /// Compares the searches on the means of a map of the cloud.
  void compareMap(const NamedCloud& input) {
    const GaussianMapOctree map = buildMap(*input.cloud, {0.1, 10, 3, 0.0}, 1);
    for (const int scale : {0, 1}) {
      auto means = pcl::make_shared<SearchCloud>();
      for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
        const Vector<3> mean = map.gaussian(i, scale).mean;
        means->emplace_back(float(mean.x()), float(mean.y()), float(mean.z()));
      }
      const Questions questions = questionsFor(*means, queries_, 2);
      Race race = raceOnPoints(means, questions);
      race.add([&map, scale, questions] { return timesOfMapSearch(map, scale, questions); });
      race.add([&map, scale, questions] { return timesOfQueries(map, scale, questions); });
      print(input.name + ", scale " + std::to_string(scale), "means", means->size(), questions, race.run(runs_));
    }
  }

  nlohmann::json json = nlohmann::json::array();

 private:
  void print(const std::string& name, const char* what, std::size_t size, const Questions& questions,
             const std::vector<Times>& all) {
    char input[160];
    std::snprintf(input, sizeof input, "%s: %zu %s, radius %.2g m", name.c_str(), size, what, questions.radius);
    const Times& flann = all[1];
    for (const Times& times : all) {
      check(times, flann);
      std::printf("| %s | %s | %.1f | %.1f | %.1f | %.1f | %.2f / %.2f / %.2f |\n", input, times.name.c_str(),
                  1e3 * times.build, 1e3 * times.nearest, 1e3 * times.ten, 1e3 * times.within,
                  (times.build + times.nearest) / (flann.build + flann.nearest),
                  (times.build + times.ten) / (flann.build + flann.ten),
                  (times.build + times.within) / (flann.build + flann.within));
      json.push_back({{"input", name},
                      {"points", size},
                      {"search", times.name},
                      {"build", times.build},
                      {"nearest", times.nearest},
                      {"ten", times.ten},
                      {"within", times.within}});
    }
    std::fflush(stdout);
  }

  /// Throws std::runtime_error if two searches disagree by more than the rounding of floats.
  static void check(const Times& times, const Times& other) {
    const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-4 * std::max(a, b); };
    if (differ(times.nearest_sum, other.nearest_sum) || differ(times.ten_sum, other.ten_sum) ||
        differ(double(times.found), double(other.found)))
      throw std::runtime_error(times.name + " and " + other.name + " find different points");
  }

  int runs_;
  std::size_t queries_;
};

}  // namespace

void addSearch(CLI::App& app) {
  struct Given {
    std::vector<std::string> paths;
    std::string json;
    int runs = 5;
    std::size_t queries = 20000;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("search", "Searches in clouds and maps beside PCL's KdTree and Octree");
  command.add_option("clouds", given->paths, "PCD files, or directories of which the first scan counts");
  command.add_option("--queries", given->queries, "number of queries")->check(CLI::Range(1, 10000000));
  command.add_option("--runs", given->runs, "of which the fastest counts")->check(CLI::Range(1, 100));
  command.add_option("--json", given->json, "file for machines");
  command.callback([given] {
    SearchComparison comparison(given->runs, given->queries);
    std::printf(
        "| input | search, %zu queries | construction [ms] | nearest [ms] | 10 nearest [ms] | in radius [ms] | with "
        "construction, relative to KdTree |\n|---|---|---|---|---|---|---|\n",
        given->queries);
    for (const NamedCloud& cloud : loadClouds(given->paths)) {
      comparison.compareCloud(cloud);
      comparison.compareMap(cloud);
    }
    if (!given->json.empty()) std::ofstream(given->json) << comparison.json.dump(2) << '\n';
  });
}

}  // namespace gaussmap::benchmark
