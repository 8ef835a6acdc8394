// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/mesh_distance.h"
#include "mesh/shapes.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

class Simulations : public testing::TestWithParam<WorldName> {};

std::string nameOf(const testing::TestParamInfo<WorldName>& world) {
  const char* const names[] = {"Corner", "Street", "Avenue", "Hall", "Plan"};
  return names[static_cast<std::size_t>(world.param)];
}

INSTANTIATE_TEST_SUITE_P(All, Simulations,
                         testing::Values(WorldName::Corner, WorldName::Street, WorldName::Avenue, WorldName::Hall,
                                         WorldName::Plan),
                         nameOf);

bool hasTraffic(WorldName world) {
  return world == WorldName::Street || world == WorldName::Avenue;
}

/// Fewer rays, no noise.
void makeCheap(Simulation& simulation, int threads = 0) {
  if (auto* const lidar = std::get_if<LidarOptions>(&simulation.sensor)) {
    lidar->columns = 180;
    lidar->noise = 0.0;
    lidar->threads = threads;
  } else {
    auto& laser = std::get<PlanarLaserOptions>(simulation.sensor);
    laser.noise = 0.0;
    laser.threads = threads;
  }
}

TEST_P(Simulations, WithoutNoiseLieOnTheirMesh) {
  Simulation simulation = makeSimulation(GetParam());
  makeCheap(simulation);
  const MeshDistance mesh(simulation.world.mesh());
  for (std::size_t i = 0; i < simulation.trajectory.size(); i += 4) {
    const SimulatedScan scan = simulateScan(simulation, i);
    EXPECT_GT(scan.points.size(), 300u);
    ASSERT_EQ(scan.truth.size(), scan.points.size());
    for (std::size_t j = 0; j < scan.points.size(); ++j) {
      const Eigen::Vector3d on_map = scan.pose * scan.points[j];
      ASSERT_LT(mesh.distance(on_map), 1e-9);
      ASSERT_LT((on_map - scan.truth[j]).norm(), 1e-9);
      ASSERT_EQ(scan.labels[j], SurfaceLabel::Static);
    }
  }
}

TEST_P(Simulations, DriveWithoutHittingAnything) {
  const Simulation simulation = makeSimulation(GetParam(), {400, false});
  const MeshDistance mesh(simulation.world.mesh());
  ASSERT_EQ(simulation.trajectory.size(), 400u);
  EXPECT_EQ(simulation.trajectory.front().time, 0.0);
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const Pose& pose = simulation.trajectory[i].pose;
    ASSERT_EQ(poseFault(pose), "");
    ASSERT_GT(mesh.distance(pose.translation), 0.25) << i;
    if (i == 0) continue;
    const Eigen::Vector3d step = pose.translation - simulation.trajectory[i - 1].pose.translation;
    const Ray ray{simulation.trajectory[i - 1].pose.translation, step.normalized()};
    ASSERT_GT(step.norm(), 0.0);
    ASSERT_FALSE(simulation.world.intersect(ray, 0.0, step.norm())) << i;  // through a wall
    ASSERT_GT(simulation.trajectory[i].time, simulation.trajectory[i - 1].time);
    ASSERT_LT(pose.rotation.angularDistance(simulation.trajectory[i - 1].pose.rotation), 0.8) << i;
  }
}

TEST_P(Simulations, AreTheSameForTheSameSeedWithAnyNumberOfThreads) {
  Simulation simulation = makeSimulation(GetParam(), {3, hasTraffic(GetParam())});
  std::visit([](auto& sensor) { sensor.threads = 1; }, simulation.sensor);
  const SimulatedScan one = simulateScan(simulation, 1, 7);
  std::visit([](auto& sensor) { sensor.threads = 2; }, simulation.sensor);
  const SimulatedScan two = simulateScan(simulation, 1, 7);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.truth, two.truth);
  EXPECT_EQ(one.labels, two.labels);
  EXPECT_NE(one.points, simulateScan(simulation, 1, 8).points);
}

TEST_P(Simulations, SpreadTheirScansOverTheSameWay) {
  const Simulation few = makeSimulation(GetParam(), {5, false}), many = makeSimulation(GetParam(), {9, false});
  const Simulation one = makeSimulation(GetParam(), {1, false});
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LT((few.trajectory[i].pose.translation - many.trajectory[2 * i].pose.translation).norm(), 1e-9);
    EXPECT_NEAR(few.trajectory[i].time, many.trajectory[2 * i].time, 1e-9);
  }
  ASSERT_EQ(one.trajectory.size(), 1u);
  EXPECT_EQ(one.trajectory[0].pose.translation, few.trajectory[0].pose.translation);
  EXPECT_THROW(simulateScan(one, 1), std::out_of_range);
}

TEST_P(Simulations, AreNotAlignedWithCells) {  // no wall runs along an axis of the map
  const TriangleMesh mesh = makeSimulation(GetParam()).world.mesh();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    const Eigen::Vector3d unit = normal.normalized();
    if (normal.norm() > 1.0 && std::abs(unit.z()) < 0.5) {
      EXPECT_LT(unit.cwiseAbs().maxCoeff(), std::cos(0.1));
    }
  }
}

TEST_P(Simulations, HaveIndependentNoiseInEachScan) {  // scan 1 of seed 1 is not scan 0 of seed 2
  Simulation simulation = makeSimulation(GetParam(), {2, false});
  simulation.trajectory[1] = simulation.trajectory[0];
  EXPECT_NE(simulateScan(simulation, 0, 1).points, simulateScan(simulation, 1, 1).points);
  EXPECT_NE(simulateScan(simulation, 0, 2).points, simulateScan(simulation, 1, 1).points);
}

TEST(Simulation, RefusesWhatThereIsNot) {
  EXPECT_THROW(makeSimulation(WorldName::Street, {-1, false}), std::invalid_argument);
  for (const WorldName name : {WorldName::Corner, WorldName::Hall, WorldName::Plan})
    EXPECT_THROW(makeSimulation(name, {0, true}), std::invalid_argument);
}

TEST(CornerSimulation, SeesAllSurfacesFromItsTrajectory) {
  const Simulation corner = makeSimulation(WorldName::Corner);
  ASSERT_EQ(corner.trajectory.size(), 5u);
  const MeshDistance mesh(corner.world.mesh());
  std::vector<std::size_t> seen(4, 0);  // floor, long wall, short wall, pole
  for (std::size_t i = 0; i < corner.trajectory.size(); ++i) {
    EXPECT_TRUE(poseFault(corner.trajectory[i].pose).empty());
    EXPECT_GT(mesh.distance(corner.trajectory[i].pose.translation), 1.0);
    for (const Eigen::Vector3d& point : simulateScan(corner, i).truth)
      ++seen[std::min<std::size_t>(3, mesh.nearest(point).triangle / 2)];  // two triangles make a rectangle
  }
  EXPECT_GT(seen[0], 50000u);
  EXPECT_GT(seen[1], 20000u);
  EXPECT_GT(seen[2], 10000u);
  EXPECT_GT(seen[3], 500u);
}

TriangleMesh movedBy(TriangleMesh mesh, const Eigen::Vector3d& offset) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex += offset;
  return mesh;
}

TEST(CornerSimulation, TurnsBetweenTheGivenPoses) {
  const Simulation corner = makeSimulation(WorldName::Corner, {9, false});
  for (std::size_t i = 1; i < 9; i += 2) {
    const Pose &before = corner.trajectory[i - 1].pose, &after = corner.trajectory[i + 1].pose;
    const double turn = before.rotation.angularDistance(after.rotation);
    EXPECT_NEAR(corner.trajectory[i].pose.rotation.angularDistance(before.rotation), turn / 2, 1e-9);
    EXPECT_NEAR(corner.trajectory[i].pose.rotation.angularDistance(after.rotation), turn / 2, 1e-9);
  }
}

class Traffic : public testing::TestWithParam<WorldName> {};
INSTANTIATE_TEST_SUITE_P(All, Traffic, testing::Values(WorldName::Street, WorldName::Avenue), nameOf);

TEST_P(Traffic, LabelsPointsOnMovingObjectsAndNoOthers) {
  Simulation street = makeSimulation(GetParam(), {0, true});
  ASSERT_EQ(street.world.moving().size(), 5u);
  makeCheap(street);
  const MeshDistance still(street.world.mesh());
  std::vector<std::size_t> points(5, 0);
  for (std::size_t i = 0; i < street.trajectory.size(); ++i) {
    std::vector<MeshDistance> moving;
    for (const MovingObject& object : street.world.moving())
      moving.emplace_back(movedBy(object.mesh, street.trajectory[i].time * object.velocity));
    const SimulatedScan scan = simulateScan(street, i);
    for (std::size_t j = 0; j < scan.truth.size(); ++j) {
      if (scan.labels[j] == SurfaceLabel::Static) {
        ASSERT_LT(still.distance(scan.truth[j]), 1e-9);
        for (const MeshDistance& object : moving) ASSERT_GT(object.distance(scan.truth[j]), 1e-9);
        continue;
      }
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < 5; ++k)
        if (moving[k].distance(scan.truth[j]) < moving[nearest].distance(scan.truth[j])) nearest = k;
      ASSERT_LT(moving[nearest].distance(scan.truth[j]), 1e-9);
      ASSERT_GT(still.distance(scan.truth[j]), 1e-9);
      ++points[nearest];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(points[k], 150u) << "car " << k;
  for (std::size_t k = 3; k < 5; ++k) EXPECT_GT(points[k], 20u) << "pedestrian " << k;
}

TEST_P(Traffic, LetsNothingCollide) {
  const Simulation street = makeSimulation(GetParam(), {100, true});
  const MeshDistance still(street.world.mesh());
  for (const TimedPose& stop : street.trajectory) {
    std::vector<TriangleMesh> meshes;
    for (const MovingObject& object : street.world.moving())
      meshes.push_back(movedBy(object.mesh, stop.time * object.velocity));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const MeshDistance object(meshes[i]);
      ASSERT_GT(object.distance(stop.pose.translation), 1.5) << i << " at " << stop.time << " s";
      for (std::size_t j = 0; j < meshes.size(); ++j)
        for (std::size_t k = 0; i != j && k < meshes[j].vertices.size(); k += 5)
          ASSERT_GT(object.distance(meshes[j].vertices[k]), 0.3) << i << " and " << j << " at " << stop.time << " s";
      for (const Eigen::Vector3d& vertex : meshes[i].vertices) {
        const MeshFoot foot = still.nearest(vertex);  // the ground below, and nothing else near
        ASSERT_TRUE(foot.distance > 0.15 || vertex.z() > foot.point.z() + 0.9 * foot.distance || foot.distance < 1e-9)
            << i << " at " << stop.time << " s: " << vertex.transpose();
      }
    }
  }
}

TEST(PlanSimulation, IsWhatItsWallsSay) {
  const Simulation plan = makeSimulation(WorldName::Plan);
  const MeshDistance mesh(plan.world.mesh());
  double length = 0.0;
  std::vector<Vector<3>> ends;
  for (const WallSegment& wall : planWalls()) {
    const Eigen::Vector2d along = wall.to - wall.from, left(-along.y(), along.x());
    length += along.norm();
    for (const double part : {0.0, 0.3, 1.0}) {
      const Eigen::Vector2d point = wall.from + part * along;
      EXPECT_LT(mesh.distance({point.x(), point.y(), 0.0}), 1e-9);
    }
    // A hand's breadth into the free space on the left there is no wall: no door, no column is that near to a middle.
    const Eigen::Vector2d free = wall.from + 0.5 * along + 0.02 * left.normalized();
    EXPECT_NEAR(mesh.distance({free.x(), free.y(), 0.0}), 0.02, 1e-9);
    for (const Eigen::Vector2d& end : {wall.from, wall.to}) ends.emplace_back(end.x(), end.y(), 0.0);
  }
  EXPECT_NEAR(surfaceArea(plan.world.mesh()), 2.5 * length, 1e-6);  // the walls are 2.5 m high, there is nothing else
  EXPECT_EQ(plan.world.mesh().triangles.size(), 2 * planWalls().size());
  for (const TimedPose& stop : plan.trajectory) EXPECT_EQ(stop.pose.translation.z(), 0.0);
}

TEST(PlanSimulation, SeesItsWallsFromTheirFreeSide) {
  Simulation plan = makeSimulation(WorldName::Plan);
  makeCheap(plan);
  std::vector<Vector<3>> seen, walls;
  for (std::size_t i = 0; i < plan.trajectory.size(); ++i) {
    const SimulatedScan scan = simulateScan(plan, i);
    EXPECT_EQ(scan.points.size(), 361u);
    seen.insert(seen.end(), scan.truth.begin(), scan.truth.end());
  }
  for (const WallSegment& wall : planWalls()) {
    const double length = (wall.to - wall.from).norm();
    for (double s = 0.02; s < length - 0.02; s += 0.05) {
      const Eigen::Vector2d point = wall.from + s / length * (wall.to - wall.from);
      walls.emplace_back(point.x(), point.y(), 0.0);
    }
  }
  std::size_t unseen = 0;
  for (const double distance : nearestDistances(walls, seen)) unseen += distance > 0.05;
  EXPECT_LT(static_cast<double>(unseen), 0.003 * static_cast<double>(walls.size())) << unseen << " of " << walls.size();
}

}  // namespace
}  // namespace gaussmap
