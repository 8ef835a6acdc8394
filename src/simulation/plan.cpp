// SPDX-License-Identifier: BSD-3-Clause
// A floor plan of 28 m x 16 m: four rooms on either side of a corridor, with walls of 12 cm between them.
#include <cmath>

#include "simulation/worlds.h"

namespace gaussmap::simulation {
namespace {

constexpr double kFree = 1.0, kSolid = 0.0;  // levels of the blocks
constexpr double kLow = -1.0, kHigh = 1.5;   // heights of the walls [m]; the laser plane is z = 0

std::vector<Block> blocks() {
  return {{0, 7, 28, 9.2, kFree},  // corridor
          {0, 0, 6.5, 6.88, kFree},        {6.62, 0, 12, 6.88, kFree},
          {12.12, 0, 19, 6.88, kFree},     {19.12, 0, 28, 6.88, kFree},
          {0, 9.32, 8, 16, kFree},         {8.12, 9.32, 14.5, 16, kFree},
          {14.62, 9.32, 22, 16, kFree},    {22.12, 9.32, 28, 16, kFree},
          {2.5, 6.88, 3.4, 7, kFree},  // doors to the corridor
          {9, 6.88, 9.9, 7, kFree},        {15, 6.88, 15.9, 7, kFree},
          {23, 6.88, 23.9, 7, kFree},      {4, 9.2, 4.9, 9.32, kFree},
          {11, 9.2, 11.9, 9.32, kFree},    {18, 9.2, 18.9, 9.32, kFree},
          {25, 9.2, 25.9, 9.32, kFree},    {19, 2.5, 19.12, 3.4, kFree},  // doors between rooms
          {8, 12, 8.12, 12.9, kFree},      {24, 0, 24.12, 3, kSolid},     // a wall that ends in the room
          {17.4, 12.4, 17.8, 12.8, kSolid}};                              // a square column
}

/// Adds the walls of a solid body. `corners` are a closed line, clockwise around the body.
void addSolid(const std::vector<Eigen::Vector2d>& corners, std::vector<Step>& steps) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    steps.push_back({corners[i], corners[(i + 1) % corners.size()], kLow, kHigh});
}

}  // namespace

Pose planPlacement() {
  return {{-12.6, -7.9, 0.0}, turned(17.0, 0.0, 0.0)};
}

std::vector<Step> planOutline() {
  std::vector<Step> steps = outline(blocks());
  for (Step& step : steps) {
    step.low = kLow;
    step.high = kHigh;
  }
  // A slanting wall of 12 cm in the second room, and a round column of 25 cm in the last one.
  const Eigen::Vector2d from(8.3, 2.2), along = Eigen::Vector2d(2.4, 1.3),
                                        across = 0.12 * Eigen::Vector2d(-1.3, 2.4) / along.norm();
  addSolid({from, from + across, from + along + across, from + along}, steps);
  constexpr int kFacets = 24;
  std::vector<Eigen::Vector2d> column;
  for (int i = 0; i < kFacets; ++i) {
    const double angle = -2.0 * std::acos(-1.0) * i / kFacets;
    column.emplace_back(25.2 + 0.25 * std::cos(angle), 12.8 + 0.25 * std::sin(angle));
  }
  addSolid(column, steps);
  return steps;
}

std::vector<Eigen::Vector2d> planPath() {
  return {{1, 8.1},      {2.6, 8.1},   {2.95, 7.6},  {2.95, 6.0},  {1.3, 4.0},    {2.0, 1.5},   {5.0, 1.5},
          {5.3, 4.5},    {3.0, 5.6},   {2.95, 6.6},  {3.2, 8.0},   {6, 8.1},      {9.2, 8.1},   {9.45, 7.6},
          {9.45, 6.0},   {7.4, 4.8},   {7.0, 2.4},   {7.1, 0.7},   {9.2, 0.7},    {11.3, 0.9},  {11.2, 4.6},
          {9.5, 5.6},    {9.45, 6.6},  {9.2, 8.0},   {6, 8.2},     {4.6, 8.3},    {4.45, 9.0},  {4.4, 10.4},
          {2.0, 12.2},   {3, 14.5},    {6.3, 14.2},  {6.8, 12.45}, {8.06, 12.45}, {9.6, 12.45}, {12.3, 14.6},
          {13.4, 12.2},  {11.5, 10.6}, {11.45, 9.0}, {12.3, 8.1},  {15.1, 8.1},   {15.45, 7.4}, {15.45, 6.0},
          {13.5, 4.2},   {14, 1.5},    {16.6, 1.6},  {17.6, 2.95}, {19.06, 2.95}, {20.4, 2.95}, {22.4, 1.6},
          {22.6, 4.2},   {24.4, 4.7},  {26.6, 4.0},  {26.6, 1.5},  {25.2, 1.6},   {25.2, 4.6},  {23.5, 5.6},
          {23.45, 6.8},  {23.2, 8.1},  {19, 8.1},    {18.5, 8.5},  {18.45, 10},   {16.2, 11},   {16, 14.5},
          {20, 14.6},    {20.4, 11.6}, {18.6, 10.6}, {18.45, 9.2}, {19.2, 8.2},   {24.6, 8.1},  {25.4, 8.5},
          {25.45, 10.2}, {26.8, 11.4}, {27, 14.4},   {23.6, 14.8}, {22.9, 12.2},  {24.4, 10.6}, {26.4, 10.4}};
}

}  // namespace gaussmap::simulation
