// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/gmap/tile_codec.h"

namespace gaussmap::detail {

/// Appends the cells of a tile as a finished map keeps them: columns of whole numbers, each as wide as it needs, the
/// Gaussians quantised (io/quantise.h), made from the moments where the tile has those. Which columns there are and how
/// long they are stands in front of them, not here. Throws std::domain_error as quantise().
template <int D>
void writeFinished(std::string& bytes, const Tile<D>& tile, const TileAddress<D>& address, const MapOptions& options);

/// Which columns there are.
struct FinishedContents {
  std::uint64_t cells = 0;
  std::uint64_t gaussians = 0;
  bool has_labels = false;
  bool has_log_odds = false;
};

/// What writeFinished() appended. Throws std::runtime_error or std::domain_error, saying what is wrong. Whoever gives
/// the bytes gives at least one for every number of a Gaussian: it allocates no more than 16 times as many.
template <int D>
Tile<D> readFinished(const char* bytes, std::size_t size, const FinishedContents& contents,
                     const TileAddress<D>& address, const MapOptions& options);

}  // namespace gaussmap::detail
