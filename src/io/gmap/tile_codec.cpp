// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/tile_codec.h"

#include <zstd.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "io/gmap/columns.h"
#include "io/gmap/final_columns.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kMaxExpansion = 64;       // how much a tile may expand; real tiles expand two or three times
constexpr std::uint64_t kMaxFinalExpansion = 16;  // the limit for final maps, whose numbers are already packed
constexpr std::uint64_t kHasMoments = 1, kHasLabels = 2, kHasLogOdds = 4, kFinal = 8;

/// Returns the numbers in front of the columns, 8 bytes each.
template <int D>
std::vector<std::uint64_t> headerOf(const TileAddress<D>& address, const MapOptions& options, std::size_t cells,
                                    std::size_t gaussians, std::uint64_t flags) {
  std::vector<std::uint64_t> header = {std::uint64_t(D),
                                       bitsOf(options.resolution),
                                       bitsOf(options.noise),
                                       std::uint64_t(options.ratio),
                                       std::uint64_t(options.scales),
                                       std::uint64_t(address.scale),
                                       cells,
                                       gaussians,
                                       flags};
  for (std::int32_t coordinate : address.tile) header.push_back(static_cast<std::uint32_t>(coordinate));
  return header;
}

constexpr std::size_t kCellsSlot = 6, kGaussiansSlot = 7, kFlagsSlot = 8;

template <int D>
std::int64_t tileOrigin(const TileAddress<D>& address, std::size_t axis) {
  return std::int64_t{address.tile[axis]} * address.span;
}

template <int D>
void checkMoments(const CellMoments<D>& moments) {
  if (moments.count <= 0 || moments.count > CellMoments<D>::kMaxPoints)
    throw std::runtime_error("a cell has an impossible count of points");
  for (std::int64_t sum : moments.sum)
    if (std::abs(static_cast<double>(sum)) > 0x1.0p15 * static_cast<double>(moments.count))
      throw std::runtime_error("the points of a cell lie outside it");
  for (std::int64_t product : moments.product)
    if (std::abs(static_cast<double>(product)) > 0x1.0p30 * static_cast<double>(moments.count))
      throw std::runtime_error("the points of a cell lie outside it");
}

template <int D>
void checkPositiveDefinite(const Matrix<D>& cov) {
  if (!cov.allFinite() || Eigen::LLT<Matrix<D>>(cov).info() != Eigen::Success)
    throw std::runtime_error("a covariance is not positive definite");
}

/// Calls body(row, column, slot) for the upper triangle of a matrix.
template <int D, typename Body>
void forTriangle(const Body& body) {
  int slot = 0;
  for (int row = 0; row < D; ++row)
    for (int column = row; column < D; ++column) body(row, column, slot++);
}

/// Appends a skippable frame if the data shrank too much. Very regular data, like a lattice of points, shrink so much
/// that decompress() would otherwise take them for a decompression bomb.
void fillUp(std::string& packed, std::size_t raw_size, std::uint64_t max_expansion) {
  constexpr std::uint32_t kSkippable = 0x184D2A50;
  const std::size_t least = raw_size / max_expansion + 1;
  if (packed.size() >= least) return;
  ColumnWriter frame(packed);
  const std::size_t fill = least - packed.size();
  for (const std::size_t number : {std::size_t{kSkippable}, fill})
    frame.write(1, 4, [&](std::size_t) { return std::uint64_t{number}; });
  packed.append(fill, '\0');
}

std::string compress(const std::string& raw, int level, std::uint64_t max_expansion) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string packed(ZSTD_compressBound(raw.size()), '\0');
  const std::size_t size = ZSTD_compress2(context.get(), packed.data(), packed.size(), raw.data(), raw.size());
  if (ZSTD_isError(size)) throw std::runtime_error(std::string("cannot be compressed: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  fillUp(packed, raw.size(), max_expansion);
  return packed;
}

std::string decompress(std::string_view packed) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > kMaxExpansion * packed.size())
    throw std::runtime_error("not a compressed tile");
  std::string raw(static_cast<std::size_t>(size), '\0');
  const std::size_t got = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  if (ZSTD_isError(got)) throw std::runtime_error(ZSTD_getErrorName(got));
  if (got != raw.size()) throw std::runtime_error("shorter than its header says");
  return raw;
}

}  // namespace

template <int D>
std::string encodeTile(const Tile<D>& tile, const TileAddress<D>& address, const MapOptions& options, int level,
                       Precision precision) {
  const std::size_t cells = tile.keys.size(), gaussians = tile.gaussianCount();
  const bool is_final = precision == Precision::Finished;
  const std::uint64_t flags = (is_final               ? kFinal
                               : tile.moments.empty() ? 0
                                                      : kHasMoments) |
                              (tile.labels.empty() ? 0 : kHasLabels) | (tile.log_odds.empty() ? 0 : kHasLogOdds);
  std::string raw;
  ColumnWriter columns(raw);
  for (std::uint64_t number : headerOf<D>(address, options, cells, gaussians, flags))
    columns.write(1, 8, [&](std::size_t) { return number; });
  if (is_final) {
    writeFinalColumns<D>(raw, tile, address, options);
    return compress(raw, level, kMaxFinalExpansion);
  }
  for (std::size_t axis = 0; axis < D; ++axis)
    columns.write(cells, 4,
                  [&](std::size_t i) { return std::uint64_t(tile.keys[i][axis] - tileOrigin<D>(address, axis)); });
  columns.write(cells, 4, [&](std::size_t i) { return std::uint64_t{tile.counts[i]}; });
  if (flags & kHasMoments) {
    const std::vector<CellMoments<D>>& moments = tile.moments;
    columns.write(cells, 8, [&](std::size_t i) { return std::uint64_t(moments[i].count); });
    for (std::size_t axis = 0; axis < D; ++axis)
      columns.write(cells, 8, [&](std::size_t i) { return std::uint64_t(moments[i].sum[axis]); });
    for (std::size_t slot = 0; slot < moments.front().product.size(); ++slot)
      columns.write(cells, 8, [&](std::size_t i) { return std::uint64_t(moments[i].product[slot]); });
  } else {
    const std::vector<Gaussian<D>>& values = tile.gaussians;
    columns.write(gaussians, 8, [&](std::size_t i) { return bitsOf(values[i].weight); });
    for (int axis = 0; axis < D; ++axis)
      columns.write(gaussians, 8, [&](std::size_t i) { return bitsOf(values[i].mean(axis)); });
    forTriangle<D>([&](int row, int column, int) {
      columns.write(gaussians, 8, [&](std::size_t i) { return bitsOf(values[i].cov(row, column)); });
    });
  }
  if (flags & kHasLabels) columns.write(gaussians, 4, [&](std::size_t i) { return std::uint64_t{tile.labels[i]}; });
  if (flags & kHasLogOdds) columns.write(gaussians, 4, [&](std::size_t i) { return bitsOf(tile.log_odds[i]); });
  return compress(raw, level, kMaxExpansion);
}

template <int D>
Tile<D> decodeTile(std::string_view bytes, const TileAddress<D>& address, const MapOptions& options) {
  const std::string raw = decompress(bytes);
  ColumnReader columns(raw.data(), raw.size());
  std::vector<std::uint64_t> header(headerOf<D>(address, options, 0, 0, 0).size());
  for (std::uint64_t& number : header) columns.read(1, 8, [&](std::size_t, std::uint64_t bits) { number = bits; });
  const std::uint64_t cells = header[kCellsSlot], gaussians = header[kGaussiansSlot], flags = header[kFlagsSlot];
  if (header != headerOf<D>(address, options, cells, gaussians, flags))
    throw std::runtime_error("belongs to another place or another map");
  const bool has_moments = flags & kHasMoments, has_labels = flags & kHasLabels, has_log_odds = flags & kHasLogOdds;
  constexpr std::uint64_t kNumbers = 1 + D + D * (D + 1) / 2;
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  if ((flags & ~(kHasMoments | kHasLabels | kHasLogOdds | kFinal)) != 0)
    throw std::runtime_error("has content that this version does not know");
  if ((flags & kFinal) != 0) {
    if (has_moments || cells == 0 || gaussians > kMax || raw.size() > kMaxFinalExpansion * bytes.size())
      throw std::runtime_error("its size does not fit its cells");
    const std::size_t begin = raw.size() - columns.left();
    try {
      const Tile<D> tile = readFinalColumns<D>(raw.data() + begin, columns.left(),
                                               {cells, gaussians, has_labels, has_log_odds}, address, options);
      for (const Gaussian<D>& gaussian : tile.gaussians) checkPositiveDefinite<D>(gaussian.cov);
      return tile;
    } catch (const std::domain_error& error) {
      throw std::runtime_error(error.what());
    }
  }
  if (cells == 0 || cells > kMax || gaussians < cells || gaussians > kMax || (has_moments && gaussians != cells) ||
      columns.left() !=
          cells * 4 * (D + 1) + gaussians * (8 * kNumbers + (has_labels ? 4 : 0) + (has_log_odds ? 4 : 0)))
    throw std::runtime_error("its size does not fit its cells");

  Tile<D> tile;
  tile.keys.resize(cells);
  tile.counts.resize(cells);
  for (std::size_t axis = 0; axis < D; ++axis)
    columns.read(cells, 4, [&](std::size_t i, std::uint64_t bits) {
      const std::int64_t coordinate = tileOrigin<D>(address, axis) + static_cast<std::int64_t>(bits);
      if (bits >= static_cast<std::uint64_t>(address.span) || coordinate != static_cast<std::int32_t>(coordinate))
        throw std::runtime_error("a cell lies outside the tile");
      tile.keys[i][axis] = static_cast<std::int32_t>(coordinate);
    });
  std::uint64_t counted = 0;
  columns.read(cells, 4, [&](std::size_t i, std::uint64_t bits) {
    tile.counts[i] = static_cast<std::uint32_t>(bits);
    counted += bits;
    if (bits == 0 || (has_moments && bits != 1)) throw std::runtime_error("a cell has a wrong number of Gaussians");
  });
  if (counted != gaussians) throw std::runtime_error("cells and Gaussians do not match");
  if (has_moments) {
    tile.moments.resize(cells);
    columns.read(cells, 8, [&](std::size_t i, std::uint64_t bits) { tile.moments[i].count = std::int64_t(bits); });
    for (std::size_t axis = 0; axis < D; ++axis)
      columns.read(cells, 8,
                   [&](std::size_t i, std::uint64_t bits) { tile.moments[i].sum[axis] = std::int64_t(bits); });
    for (std::size_t slot = 0; slot < CellMoments<D>().product.size(); ++slot)
      columns.read(cells, 8,
                   [&](std::size_t i, std::uint64_t bits) { tile.moments[i].product[slot] = std::int64_t(bits); });
    for (const CellMoments<D>& moments : tile.moments) {
      checkMoments<D>(moments);
      checkPositiveDefinite<D>(moments.gaussian(options.resolution, options.noise).cov);
    }
  } else {
    tile.gaussians.resize(gaussians);
    columns.read(gaussians, 8, [&](std::size_t i, std::uint64_t bits) { tile.gaussians[i].weight = fromBits(bits); });
    for (int axis = 0; axis < D; ++axis)
      columns.read(gaussians, 8,
                   [&](std::size_t i, std::uint64_t bits) { tile.gaussians[i].mean(axis) = fromBits(bits); });
    forTriangle<D>([&](int row, int column, int) {
      columns.read(gaussians, 8, [&](std::size_t i, std::uint64_t bits) {
        tile.gaussians[i].cov(row, column) = tile.gaussians[i].cov(column, row) = fromBits(bits);
      });
    });
    for (const Gaussian<D>& gaussian : tile.gaussians) {
      if (!gaussian.mean.allFinite() || !std::isfinite(gaussian.weight))
        throw std::runtime_error("a Gaussian is not finite");
      checkPositiveDefinite<D>(gaussian.cov);
    }
  }
  if (has_labels) {
    tile.labels.resize(gaussians);
    columns.read(gaussians, 4, [&](std::size_t i, std::uint64_t bits) { tile.labels[i] = std::uint32_t(bits); });
  }
  if (has_log_odds) {
    tile.log_odds.resize(gaussians);
    columns.read(gaussians, 4, [&](std::size_t i, std::uint64_t bits) {
      tile.log_odds[i] = floatFromBits(bits);
      if (!std::isfinite(tile.log_odds[i])) throw std::runtime_error("an occupancy is not finite");
    });
  }
  return tile;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                 \
  template std::string encodeTile<D>(const Tile<D>&, const TileAddress<D>&, const MapOptions&, int, Precision); \
  template Tile<D> decodeTile<D>(std::string_view, const TileAddress<D>&, const MapOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
