// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// The cells of one scale in one tile, in any order: the content of one row of the map file.
template <int D>
struct Tile {
  std::vector<CellKey<D>> keys;         ///< n
  std::vector<std::uint32_t> counts;    ///< n: number of Gaussians per cell
  std::vector<CellMoments<D>> moments;  ///< n, or empty
  std::vector<Gaussian<D>> gaussians;   ///< m = sum of counts, or empty; means relative to the cell's centre
  std::vector<std::uint32_t> labels;    ///< m: position of the parent within the parent cell, or empty
  std::vector<float> log_odds;          ///< m, or empty

  std::size_t gaussianCount() const { return moments.empty() ? gaussians.size() : moments.size(); }
};

/// The address of a tile. decodeTile() checks it, so that a tile cannot be mistaken for a tile of another place
/// or another map.
template <int D>
struct TileAddress {
  int scale = 0;
  CellKey<D> tile{};
  std::int32_t span = 32;  ///< cells along its side
};

/// Encodes a tile: columns with the bytes of equal significance together, then zstd with a checksum. If the
/// data shrink more than 64 times (final map: 16 times), a skippable frame follows. The bytes are little
/// endian on every machine. Throws std::domain_error if the precision is Precision::Finished and a Gaussian
/// cannot be quantised (io/gmap/quantise.h).
template <int D>
std::string encodeTile(const Tile<D>& tile, const TileAddress<D>& address, const MapOptions& options, int level,
                       Precision precision = Precision::Exact);

/// Decodes a tile. Throws std::runtime_error with the reason unless the bytes are exactly those of encodeTile() for a
/// tile at this address with these options. It allocates at most two blocks of 64 times the size of the bytes; for a
/// tile of a final map, 256 times.
template <int D>
Tile<D> decodeTile(std::string_view bytes, const TileAddress<D>& address, const MapOptions& options);

}  // namespace gaussmap::detail
