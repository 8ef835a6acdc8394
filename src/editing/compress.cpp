// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/compress.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/in_space.h"
#include "core/parallel.h"
#include "editing/ellipsoid.h"
#include "editing/keep_cells.h"
#include "gaussmap/map/sampling.h"
#include "map/coarsen.h"
#include "mapping/cell_error.h"
#include "mapping/error_factors.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Decides which cells of a scale represent the finest Gaussians under them (`data_`) well enough, see compress().
template <int D>
class CellCoverage {
 public:
  CellCoverage(const GaussianMap<D>& map, double max_error, const CompressOptions& options)
      : map_(map), max_error_(max_error), options_(options), data_(map.gaussianCount(0)) {
    parallelFor(data_.size(), options.threads, 1024, [&](std::size_t i) { data_[i] = map.gaussian(i, 0).mean; });
  }

  /// Returns one flag per cell: true if the cell has a flag in `asked` and is good enough.
  std::vector<char> goodCells(int s, const std::vector<char>& asked) const {
    std::vector<char> good = asked;
    parallelFor(good.size(), options_.threads, 4, [&](std::size_t cell) {
      if (good[cell]) good[cell] = coversItsData(cell, s);
    });
    if (std::find(good.begin(), good.end(), true) != good.end()) refuseStraying(s, good);
    return good;
  }

 private:
  /// Returns the finest Gaussians under a cell, as indices. The map must not be compressed.
  IndexRange dataUnder(std::size_t cell, int s) const {
    IndexRange cells{cell, cell + 1};
    for (int level = s; level > 0; --level)
      cells = {map_.childCells(cells.first, level).first, map_.childCells(cells.last - 1, level).last};
    return {map_.gaussiansOf(cells.first, 0).first, map_.gaussiansOf(cells.last - 1, 0).last};
  }

  bool coversItsData(std::size_t cell, int s) const {
    std::vector<Ellipsoid95<D>> ellipsoids;
    const IndexRange clusters = map_.gaussiansOf(cell, s), data = dataUnder(cell, s);
    for (std::size_t i = clusters.first; i < clusters.last; ++i) ellipsoids.emplace_back(map_.gaussian(i, s));
    return std::all_of(data_.begin() + static_cast<std::ptrdiff_t>(data.first),
                       data_.begin() + static_cast<std::ptrdiff_t>(data.last), [&](const Vector<D>& mean) {
                         return std::any_of(ellipsoids.begin(), ellipsoids.end(), [&](const Ellipsoid95<D>& ellipsoid) {
                           return ellipsoid.distance(mean) <= max_error_;
                         });
                       });
  }

  /// Clears the flags of cells with a bad Gaussian: it has no samples, or less than 95 % of them are within the maximum
  /// error of the finest means.
  void refuseStraying(int s, std::vector<char>& good) const {
    SampleOptions sampling;
    sampling.samples = 0;
    sampling.at_least = options_.samples;
    sampling.seed = options_.seed;
    sampling.threads = options_.threads;
    sampling.bounds = SampleBounds::Cell;  // compress() deletes the finer cells, so their boxes will be gone
    const MapSamples<D> samples = sampleMap<D>(map_, s, sampling);
    std::vector<std::size_t> cell_of(map_.gaussianCount(s));
    for (std::size_t cell = 0; cell < good.size(); ++cell) {
      const IndexRange clusters = map_.gaussiansOf(cell, s);
      std::fill(cell_of.begin() + static_cast<std::ptrdiff_t>(clusters.first),
                cell_of.begin() + static_cast<std::ptrdiff_t>(clusters.last), cell);
    }
    std::vector<Vector<D>> asked;
    std::vector<std::uint32_t> gaussian;
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      if (!good[cell_of[samples.gaussian[i]]]) continue;
      asked.push_back(samples.points[i]);
      gaussian.push_back(samples.gaussian[i]);
    }
    const std::vector<double> distances = nearestDistances(inSpace(asked), inSpace(data_), options_.threads);
    std::vector<std::size_t> placed(cell_of.size(), 0), near(cell_of.size(), 0);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      ++placed[gaussian[i]];
      near[gaussian[i]] += distances[i] <= max_error_ ? 1 : 0;
    }
    for (std::size_t i = 0; i < cell_of.size(); ++i)
      if (100 * near[i] < 95 * placed[i] || placed[i] == 0) good[cell_of[i]] = false;
  }

  const GaussianMap<D>& map_;
  const double max_error_;
  const CompressOptions options_;
  std::vector<Vector<D>> data_;  // [m], map frame
};

/// Decides which cells have a small error, eq. (6), and only such cells below them.
template <int D>
class CellErrorTest {
 public:
  CellErrorTest(const GaussianMap<D>& map, double max_error, const CompressOptions& options)
      : good_(static_cast<std::size_t>(map.scales())) {
    good_.front().assign(map.cellCount(0), true);
    for (int s = 1; s < map.scales(); ++s) {
      const std::vector<char>& finer = good_[static_cast<std::size_t>(s) - 1];
      std::vector<char>& good = good_[static_cast<std::size_t>(s)];
      good.resize(map.cellCount(s));
      parallelFor(good.size(), options.threads, 16, [&](std::size_t cell) {
        const IndexRange children = map.childCells(cell, s);
        good[cell] =
            std::all_of(finer.begin() + static_cast<std::ptrdiff_t>(children.first),
                        finer.begin() + static_cast<std::ptrdiff_t>(children.last), [](char one) { return one; }) &&
            errorOf(map, cell, s, options) <= max_error;
      });
    }
  }

  /// Returns one flag per cell: true if the cell has a flag in `asked` and is good enough.
  std::vector<char> goodCells(int s, const std::vector<char>& asked) const {
    std::vector<char> good = good_[static_cast<std::size_t>(s)];
    for (std::size_t cell = 0; cell < good.size(); ++cell) good[cell] = good[cell] && asked[cell];
    return good;
  }

 private:
  static double errorOf(const GaussianMap<D>& map, std::size_t cell, int s, const CompressOptions& options) {
    std::vector<Gaussian<D>> centres, data;
    const IndexRange clusters = map.gaussiansOf(cell, s);
    for (std::size_t i = clusters.first; i < clusters.last; ++i) centres.push_back(map.localGaussian(i, s));
    gatherUnder(map.scale(s - 1), map.grid(), s - 1, map.childCells(cell, s), data);
    return cellError(centres, data,
                     options.learning_factor ? errorFactors<D>(map.scale(s - 1), map.gaussiansUnder(cell, s))
                                             : std::vector<double>());
  }

  std::vector<std::vector<char>> good_;  // per scale
};

template <int D>
void check(const GaussianMap<D>& map, double max_error, const CompressOptions& options) {
  require(std::isfinite(max_error) && max_error > 0.0, "max_error", max_error,
          options.by == CompressBy::Distance ? "must be a positive number of metres" : "must be positive and finite");
  require(options.samples >= 1, "samples", static_cast<double>(options.samples), "must be at least 1");
  if (map.isCompressed())
    throw std::invalid_argument(
        "the map is already compressed, so the deleted Gaussians are missing as a reference: compress the map that it "
        "was made from");
}

/// Deletes everything below the good cells; test.goodCells(s, asked) returns those of scale s.
template <int D, typename Test>
GaussianMap<D> withoutDetail(const GaussianMap<D>& map, const Test& test) {
  std::vector<std::vector<char>> keep(static_cast<std::size_t>(map.scales()));
  keep.back().assign(map.cellCount(map.scales() - 1), true);
  bool thinner = false;
  for (int s = map.scales() - 1; s > 0; --s) {
    const std::vector<char>& kept = keep[static_cast<std::size_t>(s)];
    const std::vector<char> good = test.goodCells(s, kept);
    std::vector<char>& finer = keep[static_cast<std::size_t>(s) - 1];
    finer.resize(map.cellCount(s - 1));
    for (std::size_t cell = 0; cell < kept.size(); ++cell) {
      const IndexRange children = map.childCells(cell, s);
      std::fill(finer.begin() + static_cast<std::ptrdiff_t>(children.first),
                finer.begin() + static_cast<std::ptrdiff_t>(children.last), kept[cell] && !good[cell]);
      thinner |= static_cast<bool>(good[cell]);
    }
  }
  return thinner ? keepCells<D>(map, keep) : map;
}

}  // namespace

CompressOptions CompressOptions::yguel2009() {
  CompressOptions options;
  options.by = CompressBy::CellError;
  options.learning_factor = true;
  return options;
}

template <int D>
GaussianMap<D> compress(GaussianMap<D> map, double max_error, const CompressOptions& options) {
  check(map, max_error, options);
  if (map.empty() || map.scales() == 1) return map;
  if (options.by == CompressBy::CellError) return withoutDetail<D>(map, CellErrorTest<D>(map, max_error, options));
  return withoutDetail<D>(map, CellCoverage<D>(map, max_error, options));
}

template GaussianMap<2> compress<2>(GaussianMap<2>, double, const CompressOptions&);
template GaussianMap<3> compress<3>(GaussianMap<3>, double, const CompressOptions&);

}  // namespace gaussmap
