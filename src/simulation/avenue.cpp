// SPDX-License-Identifier: BSD-3-Clause
// An avenue of 150 m along x: the road from y = -5 to 5, kerbs, sidewalks, 27 trees, building fronts in relief from
// 8.5 m on, a side road, a park.
#include <cmath>

#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

constexpr double kKerb = 0.12;  // height of the sidewalk [m]
constexpr double kFront = 8.5;  // distance of the foremost buildings from the middle of the road [m]
constexpr double kDeep = 14.0;  // depth of a building [m]

struct Building {
  double x0, x1;    // along the street
  double set_back;  // behind the foremost fronts
  double height;
  double bay;  // distance from one window to the next
  int oriels;  // an oriel after every so many windows, 0 = no oriels
};

/// Returns a front in the plane of x and height. The level of a block is its distance in front of the wall [m].
std::vector<Block> frontBlocks(const Building& building) {
  constexpr double kStorey = 3.1, kWindow = 1.25, kSill = 0.95, kWindowHeight = 1.55, kMargin = 0.2;
  const double width = building.x1 - building.x0;
  std::vector<Block> blocks = {
      {0, 0, width, building.height, 0},
      {kMargin, 0, width - kMargin, 0.6, 0.06},                                        // plinth
      {kMargin, building.height - 0.6, width - kMargin, building.height - 0.2, 0.3}};  // cornice
  const int bays = static_cast<int>((width - 1.0) / building.bay);
  const double first = (width - bays * building.bay) / 2;
  for (int storey = 0; (storey + 1) * kStorey < building.height; ++storey) {
    for (int i = 0; i < bays; ++i) {
      const double x = first + (i + 0.5) * building.bay - kWindow / 2, z = storey * kStorey + kSill;
      if (storey == 0 && i == bays / 2) {
        blocks.push_back({x - 0.1, 0, x + kWindow + 0.1, 2.4, -0.55});  // the door
        continue;
      }
      const bool is_oriel = building.oriels > 0 && storey > 0 && i % building.oriels == 1;
      const double face = is_oriel ? 0.7 : 0.0;
      if (is_oriel) blocks.push_back({x - 0.35, z - 0.7, x + kWindow + 0.35, z + kWindowHeight + 0.4, face});
      blocks.push_back({x, z, x + kWindow, z + kWindowHeight, face - 0.2});
    }
  }
  return blocks;
}

/// Returns a building from x = 0 to its width. Its front lies in y = 0 and faces -y.
TriangleMesh buildingMesh(const Building& building) {
  const double width = building.x1 - building.x0, height = building.height;
  Pose upright;
  upright.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(std::acos(-1.0) / 2, Eigen::Vector3d::UnitX()));
  TriangleMesh mesh = transformed(terraceMesh(frontBlocks(building)), upright);
  append(mesh, rectangleMesh({{0, 0, 0}, {0, 0, height}, {0, kDeep, 0}}));
  append(mesh, rectangleMesh({{width, 0, 0}, {0, kDeep, 0}, {0, 0, height}}));
  append(mesh, rectangleMesh({{0, kDeep, 0}, {0, 0, height}, {width, 0, 0}}));
  append(mesh, rectangleMesh({{0, 0, height}, {width, 0, 0}, {0, kDeep, 0}}));
  return mesh;
}

void addBuildings(TriangleMesh& mesh) {
  const std::vector<Building> left = {{-20, -7, 0.0, 11.0, 2.4, 0}, {-7, 6, 0.9, 13.4, 2.9, 3},
                                      {6, 20, 0.0, 10.1, 2.6, 0},   {20, 31, 1.3, 14.2, 2.5, 2},
                                      {31, 43, 0.4, 11.6, 3.1, 0},  {47, 60, 0.0, 12.9, 2.7, 3},
                                      {60, 72, 1.0, 9.7, 2.4, 0},   {112, 130, 0.3, 12.2, 2.8, 4}};
  const std::vector<Building> right = {
      {-20, -4, 0.2, 12.5, 2.7, 3}, {-4, 12, 0.0, 10.4, 2.5, 0}, {12, 26, 0.7, 13.0, 2.9, 2},
      {41, 55, 0.0, 11.2, 2.6, 0},  {55, 68, 1.1, 13.8, 3.0, 3}, {68, 84, 0.3, 10.8, 2.5, 0},
      {84, 96, 0.0, 12.1, 2.8, 2},  {96, 112, 0.9, 9.9, 2.4, 0}, {112, 130, 0.0, 13.1, 2.7, 3}};
  for (const Building& building : left)
    append(mesh, placed(buildingMesh(building), building.x0, kFront + building.set_back, 0, 0));
  for (const Building& building : right)
    append(mesh, placed(buildingMesh(building), building.x1, -kFront - building.set_back, 0, 180));
  append(mesh, placed(buildingMesh({70, 114, 0, 15.3, 3.1, 0}), 70, 24, 0, 0));    // behind the park
  append(mesh, placed(buildingMesh({22, 45, 0, 14.0, 2.8, 4}), 45, -34, 0, 180));  // at the end of the side road
}

TriangleMesh ground() {
  return terraceMesh({{-20, -11, 130, 11, kKerb},
                      {-20, -5, 130, 5, 0.0},     // road
                      {26, -35, 41, -11, kKerb},  // side road with its sidewalks
                      {30, -35, 37, -5, 0.0},
                      {43, 11, 47, 24, kKerb},   // an alley
                      {72, 11, 112, 25, 0.2},    // the lawn of a park
                      {50, 5, 53, 5.8, 0.03}});  // a kerb lowered for a gate
}

void addCars(TriangleMesh& mesh) {
  const std::vector<double> right = {4, 10.5, 17, 46.5, 53, 66, 72.5, 79, 106, 113},
                            left = {0, 13, 19.5, 26, 40, 59, 65.5, 72, 85, 104, 118};
  int number = 0;
  for (const double x : right) {
    const bool is_van = ++number % 4 == 0;
    append(mesh, placed(is_van ? vanMesh() : carMesh(), x, -4.0 + 0.04 * (number % 3), 0, 1.1 * (number % 5) - 2.0));
  }
  for (const double x : left) {
    const bool is_van = ++number % 5 == 0;
    append(mesh, placed(is_van ? vanMesh() : carMesh(), x, 4.0 - 0.05 * (number % 3), 0, 181.5 - 0.9 * (number % 4)));
  }
}

void addFurniture(TriangleMesh& mesh) {
  for (unsigned tree = 0; tree < 13; ++tree) {
    const double x = -14 + 11.5 * tree;
    const double crown = 1.5 + 0.15 * (tree % 4);
    append(mesh, placed(treeMesh(2.9 + 0.1 * (tree % 3), crown, tree + 1), x, 6.1, kKerb, 0));
    if (x < 24 || x > 43)
      append(mesh, placed(treeMesh(2.8, 1.4 + 0.2 * (tree % 3), tree + 41), x + 4.5, -6.1, kKerb, 0));
  }
  for (const auto& [x, y] :
       std::vector<std::pair<double, double>>{{78, 14.5}, {86, 19}, {95, 15.5}, {103, 20}, {108, 14}})
    append(mesh, placed(treeMesh(2.6, 2.2, static_cast<unsigned>(x)), x, y, 0.2, 0));
  for (int lamp = 0; lamp < 6; ++lamp) {
    const double x = -10 + 24.0 * lamp;
    append(mesh, placed(lampMesh(), x + 2, 5.5, kKerb, -90));
    append(mesh, placed(lampMesh(), x + 14, -5.5, kKerb, 90));
  }
  append(mesh, placed(fenceMesh(38), 73, 10.6, kKerb, 0));
  append(mesh, boxMesh({76, 12.2, 0.2}, {90, 13.1, 1.3}));  // a hedge
  append(mesh, placed(shelterMesh(), 62, -7.6, kKerb, 90));
  for (const double x : {89.0, 97.0}) append(mesh, placed(benchMesh(), x, 9.9, kKerb, -90));
  for (const double x : {9.0, 47.5, 100.5})  // bins
    append(mesh, cylinderMesh({{x, -5.7, kKerb}, {0, 0, 0.9}, 0.25}, 24, CylinderEnds::Closed));
  for (const double x : {28.5, 91.5}) {  // signs
    append(mesh, cylinderMesh({{x, -5.4, kKerb}, {0, 0, 2.6}, 0.035}, 12));
    append(mesh, boxMesh({x - 0.06, -5.72, 2.0}, {x - 0.04, -5.08, 2.65}));
  }
}

}  // namespace

TriangleMesh avenueMesh() {
  TriangleMesh mesh = ground();
  addBuildings(mesh);
  addCars(mesh);
  addFurniture(mesh);
  return mesh;
}

}  // namespace gaussmap::simulation
