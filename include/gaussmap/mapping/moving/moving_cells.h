// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap {

/// Lengths in metres, not in cells: counted in cells they would mean something else at every resolution.
struct MovingCellOptions {
  OccupancyOptions occupancy;
  double min_points = 10.0;  ///< freed cells that hold together with fewer points than this are noise and stay
  double link = 0.2;         ///< cells so close to each other hold together [m], at least one cell
  double reach = 0.5;        ///< how far an object reaches beyond its freed cells, at most [m]
};

/// In a cell that an object shares with a floor or wall, points are told apart by the surface that the scans saw while
/// the object was not there.
struct SharedCellOptions {
  double reach = 0.6;      ///< how far around a cell the surface may be known from [m]
  double flatness = 0.04;  ///< standard deviation across the surface, at most [m]: more is none
  double noise = 0.01;     ///< a point within this or three standard deviations of the surface belongs to it [m]
};

/// Which finest cells of a map held an object that has moved; `evidence` as gatherEvidence() gives it. Three steps:
/// - free: some scan hit it, but the log-odds of all scans are below 0;
/// - restore: freed cells that hold together with few points are noise of sensor or pose;
/// - grow: what stands beside a freed cell and was seen only while that one was is of the same object, though no beam
///   has passed there since (its lower parts, its far side).
/// Throws std::invalid_argument if there is not one evidence a cell, or an option is not usable.
std::vector<bool> findMovingCells(const GaussianMap<3>& map, const std::vector<Evidence>& evidence,
                                  const MovingCellOptions& options = {});

}  // namespace gaussmap
