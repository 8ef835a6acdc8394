// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gaussmap/core/scans.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/map/gaussian_map.h"
#include "mesh/mesh_distance.h"

namespace gaussmap::papers {

/// A recording, and the truth to which maps of it are compared.
template <int D>
struct Sequence {
  std::string name;
  MapOptions map;
  std::vector<Scan> scans;
  std::shared_ptr<const detail::MeshDistance> mesh;  ///< the true surface; empty: the points of the scans

  /// Returns all returns of the first `count` scans [m, map frame]; z = 0 in 2-D.
  std::vector<Vector<3>> points(std::size_t count) const;
};

/// Returns the simulated plan (240 scans), and if `data` has it, the log of the Intel lab (910 scans), with cells of
/// 5 cm as in the paper. At most `scans` scans of each; 0: all.
std::vector<Sequence<2>> planarSequences(const std::filesystem::path& data, std::size_t scans);
/// Returns the simulated street (320 scans, with a smaller sensor than usual), and if `data` has it, a drive of MulRan
/// (21 scans), with cells of 10 cm as in the paper.
std::vector<Sequence<3>> sequencesInSpace(const std::filesystem::path& data, std::size_t scans);

/// The distances of samples from the truth.
struct SampleDistances {
  DistanceSummary all;
  double within_two_sigma = 0.0;  ///< the largest distance of a sample within 2 sigma of its mean [m]
};

/// Draws samples of a scale as in the paper (sec. 6): their number is proportional to the volume of the ellipsoids, and
/// samples outside the cell of their Gaussian are rejected. Returns their distances to the truth of the first `scans`
/// scans.
template <int D>
SampleDistances distancesOf(const GaussianMap<D>& map, int scale, std::size_t samples, const Sequence<D>& sequence,
                            std::size_t scans);

/// Returns the sum of sqrt(det Sigma) of the Gaussians of a scale [m^D]: their volume, up to a constant factor.
template <int D>
double volumeOf(const GaussianMap<D>& map, int scale);

}  // namespace gaussmap::papers
