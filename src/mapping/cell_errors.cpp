// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "gaussmap/mapping/refine.h"
#include "map/coarsen.h"
#include "mapping/contribution.h"

namespace gaussmap {
using namespace detail;

template <int D>
CellErrors cellErrors(const GaussianMap<D>& map, int scale, int threads) {
  if (scale < 1 || scale >= map.scales())
    throw std::out_of_range("cellErrors: scale " + std::to_string(scale) + "; the coarse scales of the map are 1 to " +
                            std::to_string(map.scales() - 1));
  constexpr std::size_t kGrain = 4;
  CellErrors errors;
  errors.cells.assign(map.cellCount(scale), std::numeric_limits<double>::quiet_NaN());
  errors.contributions.resize(map.gaussianCount(scale - 1));
  parallelFor(map.cellCount(scale), threads, kGrain, [&](std::size_t cell) {
    if (map.isLeaf(cell, scale)) return;
    std::vector<Gaussian<D>> data, centres;  // means relative to the centre of the cell
    gatherUnder(map.scale(scale - 1), map.grid(), scale - 1, map.childCells(cell, scale), data);
    const IndexRange clusters = map.gaussiansOf(cell, scale);
    for (std::size_t i = clusters.first; i < clusters.last; ++i) centres.push_back(map.localGaussian(i, scale));
    const std::size_t first = map.gaussiansUnder(cell, scale).first;
    double sum = 0.0;
    for (std::size_t j = 0; j < data.size(); ++j) {
      errors.contributions[first + j] = contributionOf(data[j], centres);
      sum += errors.contributions[first + j];
    }
    errors.cells[cell] = sum / static_cast<double>(data.size());  // eq. (6)
  });
  return errors;
}

template CellErrors cellErrors<2>(const GaussianMap<2>&, int, int);
template CellErrors cellErrors<3>(const GaussianMap<3>&, int, int);

}  // namespace gaussmap
