// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Appends the cells of a tile in the format of a final map: columns of whole numbers, each as wide as necessary.
/// The Gaussians are quantised (io/gmap/quantise.h); those of a tile with moments are computed from the moments.
/// The columns do not state their number and length; the caller stores both in front of them. Throws
/// std::domain_error like quantise().
template <int D>
void writeFinalColumns(std::string& bytes, const Tile<D>& tile, const TileAddress<D>& address,
                       const MapOptions& options);

/// The columns of a tile of a final map.
struct FinalContents {
  std::uint64_t cells = 0;
  std::uint64_t gaussians = 0;
  bool has_labels = false;
  bool has_log_odds = false;
};

/// Reads the columns of writeFinalColumns(). Throws std::runtime_error or std::domain_error with the reason. Every
/// number of a Gaussian takes at least one byte, so this allocates at most 16 times `size`.
template <int D>
Tile<D> readFinalColumns(const char* bytes, std::size_t size, const FinalContents& contents,
                         const TileAddress<D>& address, const MapOptions& options);

}  // namespace gaussmap::detail
