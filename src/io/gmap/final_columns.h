// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Appends the cells of a tile as a final map keeps them: columns of whole numbers, each as wide as it needs, the
/// Gaussians quantised (io/quantise.h), made from the moments where the tile has those. Which columns there are and how
/// long they are stands in front of them, not here. Throws std::domain_error as quantise().
template <int D>
void writeFinalColumns(std::string& bytes, const Tile<D>& tile, const TileAddress<D>& address,
                       const MapOptions& options);

/// Which columns there are.
struct FinalContents {
  std::uint64_t cells = 0;
  std::uint64_t gaussians = 0;
  bool has_labels = false;
  bool has_log_odds = false;
};

/// What writeFinalColumns() appended. Throws std::runtime_error or std::domain_error, saying what is wrong. Whoever
/// gives the bytes gives at least one for every number of a Gaussian: it allocates no more than 16 times as many.
template <int D>
Tile<D> readFinalColumns(const char* bytes, std::size_t size, const FinalContents& contents,
                         const TileAddress<D>& address, const MapOptions& options);

}  // namespace gaussmap::detail
