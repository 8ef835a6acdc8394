// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark normals [DIR or PCD...] [--json FILE]: compares CellNormalEstimation with pcl::NormalEstimationOMP
// (20 neighbours): times with one and two threads, and the angle between their normals. For the simulated street, also
// prints the angles to the true normals.
#include <pcl/features/normal_3d_omp.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

#include "clock.h"
#include "clouds.h"
#include "gaussmap/pcl/normal_estimation.h"
#include "mesh/mesh_tree.h"
#include "subcommands.h"
#include "table.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

using Normals = pcl::PointCloud<pcl::Normal>;

constexpr int kNeighbours = 20;

double degrees(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return 180.0 / M_PI * std::acos(std::min(1.0, std::abs(double(a.dot(b)))));
}

struct Angles {
  double median = 0.0, q75 = 0.0, q90 = 0.0;
};

template <typename NormalAt>
Angles anglesOf(const Normals& normals, const NormalAt& expected) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3f own = normals[i].getNormalVector3fMap(), other = expected(i);
    if (own.allFinite() && other.allFinite()) angles.push_back(degrees(own, other));
  }
  std::sort(angles.begin(), angles.end());
  if (angles.empty()) return {};
  return {angles[angles.size() / 2], angles[angles.size() * 3 / 4], angles[angles.size() * 9 / 10]};
}

void compare(const NamedCloud& input, int runs, Table& table) {
  for (const int threads : {1, 2}) {
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> theirs(static_cast<unsigned>(threads));
    CellNormalEstimation<pcl::PointXYZ> ours;
    ours.setNumberOfThreads(threads);
    theirs.setKSearch(kNeighbours);
    ours.setKSearch(kNeighbours);
    theirs.setInputCloud(input.cloud);
    ours.setInputCloud(input.cloud);
    Normals their_normals, our_normals;
    // One thread: processor time, which other programs on the machine do not disturb.
    const auto now = threads == 1 ? processorSeconds : wallSeconds;
    double our_seconds = std::numeric_limits<double>::infinity(), their_seconds = our_seconds;
    for (int i = 0; i < runs; ++i) {
      double start = now();
      ours.compute(our_normals);
      our_seconds = std::min(our_seconds, now() - start);
      start = now();
      theirs.setSearchMethod(nullptr);  // building the tree is part of the work
      theirs.compute(their_normals);
      their_seconds = std::min(their_seconds, now() - start);
    }
    const Angles angles =
        anglesOf(our_normals, [&](std::size_t i) { return Eigen::Vector3f(their_normals[i].getNormalVector3fMap()); });
    std::printf("| %-32s | %7zu | %d | %7.1f | %7.1f | %5.1f | %5.2f | %5.2f | %5.2f |\n", input.name.c_str(),
                input.cloud->size(), threads, 1e3 * their_seconds, 1e3 * our_seconds, their_seconds / our_seconds,
                angles.median, angles.q75, angles.q90);
    std::fflush(stdout);
    table.rows.push_back(
        Row{"normals", input.name, threads, our_seconds, 0.0, "pcl::NormalEstimationOMP", their_seconds, 0.0});
    if (threads == 1)
      table.figures.push_back(
          Figure{"normals", input.name, "median angle to the normals of PCL", "degrees", angles.median});
  }
}

/// Returns the same points as an unorganised cloud. In an organised cloud PCL searches the neighbours in the picture.
NamedCloud asList(const NamedCloud& organised) {
  const auto list = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*organised.cloud);
  list->width = static_cast<std::uint32_t>(list->size());
  list->height = 1;
  return {organised.name + ", as a list", list};
}

/// Compares the normals with those of the surfaces that the rays met.
void compareWithTruth(Table& table) {
  const Simulation street = makeSimulation(WorldName::Street, {1, false});
  const SimulatedScan scan = simulateScan(street, 0);
  const TriangleMesh& mesh = street.world.mesh();
  const MeshTree tree(mesh);
  const Eigen::Matrix3d to_sensor = scan.pose.rotation.toRotationMatrix().transpose();
  std::vector<Eigen::Vector3f> truth;
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Eigen::Vector3f p = scan.points[i].cast<float>();
    cloud->emplace_back(p.x(), p.y(), p.z());
    const auto& corners = mesh.triangles[tree.nearest(scan.truth[i])->triangle];
    const Eigen::Vector3d a = mesh.vertices[corners[0]], b = mesh.vertices[corners[1]], c = mesh.vertices[corners[2]];
    truth.push_back((to_sensor * (b - a).cross(c - a).normalized()).cast<float>());
  }
  std::printf(
      "\n| simulated street, angle to the true normal [degrees] | median | 75 %% | 90 %% |\n|---|---|---|---|\n");
  const auto row = [&](const char* name, pcl::Feature<pcl::PointXYZ, pcl::Normal>& method) {
    method.setKSearch(kNeighbours);
    method.setInputCloud(cloud);
    Normals normals;
    method.compute(normals);
    const Angles angles = anglesOf(normals, [&](std::size_t i) { return truth[i]; });
    std::printf("| %-44s | %5.2f | %5.2f | %5.2f |\n", name, angles.median, angles.q75, angles.q90);
    table.figures.push_back(Figure{"normals", "simulated street",
                                   std::string(name) + ", median angle to the true normals", "degrees", angles.median});
  };
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> theirs(1);
  CellNormalEstimation<pcl::PointXYZ> ours;
  row("pcl::NormalEstimationOMP", theirs);
  row("CellNormalEstimation", ours);
}

}  // namespace

void addNormals(CLI::App& app) {
  struct Given {
    std::vector<std::string> paths;
    std::string json;
    int runs = 5;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("normals", "CellNormalEstimation beside pcl::NormalEstimationOMP");
  command.add_option("clouds", given->paths, "PCD files, or directories of which the first scan counts");
  command.add_option("--runs", given->runs, "of which the fastest counts")->check(CLI::Range(1, 100));
  command.add_option("--json", given->json, "file for machines");
  command.callback([given] {
    Table table;
    std::printf(
        "| %-32s | points  | threads | pcl [ms] | ours [ms] | pcl / ours | angle between them, median [degrees] | 75 "
        "%% "
        "| 90 %% |\n|---|---|---|---|---|---|---|---|---|\n",
        "cloud");
    for (const NamedCloud& cloud : loadClouds(given->paths)) {
      compare(cloud, given->runs, table);
      if (cloud.cloud->isOrganized()) compare(asList(cloud), given->runs, table);
    }
    compareWithTruth(table);
    if (!given->json.empty()) writeJson(given->json, table);
  });
}

}  // namespace gaussmap::benchmark
