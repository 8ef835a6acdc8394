// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/final_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "io/gmap/columns.h"
#include "io/gmap/quantise.h"

namespace gaussmap::detail {
namespace {

/// Number of columns per Gaussian: weight, mean, factor of the covariance.
template <int D>
constexpr std::uint64_t kNumbers = 1 + 2 * D + QuantisedGaussian<D>::kLower;

constexpr std::int64_t kLargestNumber = std::int64_t{1} << 62;  // all numbers are smaller, so differences fit

int widthOf(std::uint64_t most) {
  int width = 0;
  for (; most > 0; most >>= 8) ++width;
  return width;
}

/// Writes a column of whole numbers: the width in bytes (1 byte), the minimum (8 bytes), then each number
/// minus the minimum.
template <typename ValueAt>
void writeNumbers(std::string& bytes, std::size_t count, int least_width, const ValueAt& value) {
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = std::numeric_limits<std::int64_t>::min();
  for (std::size_t i = 0; i < count; ++i) {
    low = std::min(low, value(i));
    high = std::max(high, value(i));
  }
  const int width = std::max(least_width, widthOf(static_cast<std::uint64_t>(high - low)));
  ColumnWriter columns(bytes);
  columns.write(1, 1, [&](std::size_t) { return static_cast<std::uint64_t>(width); });
  columns.write(1, 8, [&](std::size_t) { return static_cast<std::uint64_t>(low); });
  columns.write(count, width, [&](std::size_t i) { return static_cast<std::uint64_t>(value(i) - low); });
}

template <typename Take>
void readNumbers(ColumnReader& columns, std::size_t count, int least_width, const Take& take) {
  std::uint64_t width = 0, low = 0;
  columns.read(1, 1, [&](std::size_t, std::uint64_t bits) { width = bits; });
  columns.read(1, 8, [&](std::size_t, std::uint64_t bits) { low = bits; });
  if (width < static_cast<std::uint64_t>(least_width) || width > 8)
    throw std::runtime_error("a column has a wrong width");
  columns.read(count, static_cast<int>(width), [&](std::size_t i, std::uint64_t bits) {
    const auto number = static_cast<std::int64_t>(low + bits);
    if (number <= -kLargestNumber || number >= kLargestNumber) throw std::runtime_error("a number is too large");
    take(i, number);
  });
}

}  // namespace

template <int D>
void writeFinalColumns(std::string& bytes, const Tile<D>& tile, const TileAddress<D>& address,
                       const MapOptions& options) {
  const std::size_t cells = tile.keys.size(), gaussians = tile.gaussianCount();
  std::vector<QuantisedGaussian<D>> numbers;
  numbers.reserve(gaussians);
  for (std::size_t i = 0; i < gaussians; ++i)
    numbers.push_back(quantise<D>(
        tile.moments.empty() ? tile.gaussians[i] : tile.moments[i].gaussian(options.resolution, options.noise),
        options.noise));
  for (std::size_t axis = 0; axis < D; ++axis)
    writeNumbers(bytes, cells, 0, [&](std::size_t i) {
      return std::int64_t{tile.keys[i][axis]} - std::int64_t{address.tile[axis]} * address.span;
    });
  writeNumbers(bytes, cells, 0, [&](std::size_t i) { return std::int64_t{tile.counts[i]}; });
  writeNumbers(bytes, gaussians, 1, [&](std::size_t i) { return numbers[i].weight; });
  for (std::size_t axis = 0; axis < D; ++axis)
    writeNumbers(bytes, gaussians, 1, [&](std::size_t i) { return numbers[i].mean[axis]; });
  for (std::size_t axis = 0; axis < D; ++axis)
    writeNumbers(bytes, gaussians, 1, [&](std::size_t i) { return numbers[i].diagonal[axis]; });
  for (std::size_t slot = 0; slot < QuantisedGaussian<D>::kLower; ++slot)
    writeNumbers(bytes, gaussians, 1, [&](std::size_t i) { return numbers[i].lower[slot]; });
  if (!tile.labels.empty())
    writeNumbers(bytes, gaussians, 0, [&](std::size_t i) { return std::int64_t{tile.labels[i]}; });
  if (!tile.log_odds.empty())
    writeNumbers(bytes, gaussians, 0, [&](std::size_t i) { return quantiseLogOdds(tile.log_odds[i]); });
}

template <int D>
Tile<D> readFinalColumns(const char* bytes, std::size_t size, const FinalContents& contents,
                         const TileAddress<D>& address, const MapOptions& options) {
  const std::uint64_t cells = contents.cells, gaussians = contents.gaussians;  // lambdas cannot capture bindings
  if (gaussians > size / kNumbers<D> || cells > gaussians) throw std::runtime_error("shorter than its cells need");
  ColumnReader columns(bytes, size);
  Tile<D> tile;
  tile.keys.resize(cells);
  tile.counts.resize(cells);
  for (std::size_t axis = 0; axis < D; ++axis)
    readNumbers(columns, cells, 0, [&](std::size_t i, std::int64_t number) {
      const std::int64_t first = std::int64_t{address.tile[axis]} * address.span;
      if (number < 0 || number >= address.span || first + number != static_cast<std::int32_t>(first + number))
        throw std::runtime_error("a cell lies outside the tile");
      tile.keys[i][axis] = static_cast<std::int32_t>(first + number);
    });
  std::uint64_t counted = 0;
  readNumbers(columns, cells, 0, [&](std::size_t i, std::int64_t number) {
    if (number < 1 || static_cast<std::uint64_t>(number) > gaussians)
      throw std::runtime_error("a cell has a wrong number of Gaussians");
    tile.counts[i] = static_cast<std::uint32_t>(number);
    counted += tile.counts[i];
  });
  if (counted != gaussians) throw std::runtime_error("cells and Gaussians do not match");

  std::vector<QuantisedGaussian<D>> numbers(gaussians);
  readNumbers(columns, gaussians, 1, [&](std::size_t i, std::int64_t number) { numbers[i].weight = number; });
  for (std::size_t axis = 0; axis < D; ++axis)
    readNumbers(columns, gaussians, 1, [&](std::size_t i, std::int64_t number) { numbers[i].mean[axis] = number; });
  for (std::size_t axis = 0; axis < D; ++axis)
    readNumbers(columns, gaussians, 1, [&](std::size_t i, std::int64_t number) { numbers[i].diagonal[axis] = number; });
  for (std::size_t slot = 0; slot < QuantisedGaussian<D>::kLower; ++slot)
    readNumbers(columns, gaussians, 1, [&](std::size_t i, std::int64_t number) { numbers[i].lower[slot] = number; });
  const double side = Grid<D>(options).side(address.scale);
  tile.gaussians.reserve(gaussians);
  for (const QuantisedGaussian<D>& one : numbers) tile.gaussians.push_back(dequantise<D>(one, options.noise, side));

  if (contents.has_labels) {
    tile.labels.resize(gaussians);
    readNumbers(columns, gaussians, 0, [&](std::size_t i, std::int64_t number) {
      if (number < 0 || number > std::numeric_limits<std::uint32_t>::max())
        throw std::runtime_error("the parent of a Gaussian is impossible");
      tile.labels[i] = static_cast<std::uint32_t>(number);
    });
  }
  if (contents.has_log_odds) {
    tile.log_odds.resize(gaussians);
    readNumbers(columns, gaussians, 0,
                [&](std::size_t i, std::int64_t number) { tile.log_odds[i] = dequantiseLogOdds(number); });
  }
  if (columns.left() > 0) throw std::runtime_error("its size does not fit its cells");
  return tile;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                               \
  template void writeFinalColumns<D>(std::string&, const Tile<D>&, const TileAddress<D>&, const MapOptions&); \
  template Tile<D> readFinalColumns<D>(const char*, std::size_t, const FinalContents&, const TileAddress<D>&, \
                                       const MapOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
