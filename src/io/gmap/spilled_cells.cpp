// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/spilled_cells.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "core/parallel.h"
#include "io/gmap/map_schema.h"
#include "map/map_scale_builder.h"

namespace gaussmap::detail {
namespace {

/// The cells of one tile as they are stored in the file: moments at the finest scale, else Gaussians.
template <int D>
struct Piece {
  std::vector<CellKey<D>> keys;
  std::vector<CellMoments<D>> moments;
  std::vector<std::uint32_t> counts;
  std::vector<Gaussian<D>> gaussians;
  std::vector<double> areas;

  std::string bytes() const {
    std::string bytes;
    putArray(bytes, keys);
    putArray(bytes, moments);
    putArray(bytes, counts);
    putArray(bytes, gaussians);
    putArray(bytes, areas);
    return bytes;
  }
  void append(const std::string& bytes) {
    std::size_t place = 0;
    takeArray(bytes, place, keys);
    takeArray(bytes, place, moments);
    takeArray(bytes, place, counts);
    takeArray(bytes, place, gaussians);
    takeArray(bytes, place, areas);
  }
};

/// Merges cells that occur more than once, by adding their moments.
template <int D>
Piece<D> withEachCellOnce(const Piece<D>& piece) {
  std::vector<std::uint32_t> order(piece.keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return piece.keys[a] < piece.keys[b]; });
  Piece<D> once;
  for (const std::uint32_t from : order) {
    if (once.keys.empty() || once.keys.back() != piece.keys[from]) {
      once.keys.push_back(piece.keys[from]);
      once.moments.push_back(piece.moments[from]);
    } else {
      once.moments.back() += piece.moments[from];
    }
  }
  return once;
}

/// Appends the cells in key order.
template <int D>
void appendInOrder(MapScaleBuilder<D>& cells, std::vector<double>& areas, const Piece<D>& piece,
                   const MapOptions& options, int scale) {
  std::vector<std::size_t> first(piece.keys.size() + 1, 0);
  for (std::size_t i = 0; i < piece.counts.size(); ++i) first[i + 1] = first[i] + piece.counts[i];
  for (const std::uint32_t from : keyOrder<D>(piece.keys, options.ratio, options.scales - 1 - scale)) {
    cells.addCell(piece.keys[from]);
    if (scale == 0) {
      cells.addMoments(piece.moments[from]);
      areas.push_back(1.0);
      continue;
    }
    for (std::size_t i = first[from]; i < first[from + 1]; ++i) {
      cells.addGaussian(piece.gaussians[i]);
      areas.push_back(piece.areas[i]);
    }
  }
}

}  // namespace

template <int D>
SpilledCells<D>::SpilledCells(SpillFile& file, const MapOptions& options, int scale)
    : file_(file), options_(options), scale_(scale) {}

template <int D>
void SpilledCells<D>::add(const MomentGrid<D>& moments) {
  const std::int32_t span = tileSpan(options_);
  std::map<CellKey<D>, std::vector<std::uint32_t>> by_tile;
  std::vector<std::uint32_t>* last = nullptr;
  CellKey<D> last_tile{};
  for (std::size_t i = 0; i < moments.size(); ++i) {  // consecutive cells are often in the same tile
    const CellKey<D> tile = tileOf<D>(moments[i].key, span);
    if (last == nullptr || tile != last_tile) last = &by_tile[tile];
    last_tile = tile;
    last->push_back(static_cast<std::uint32_t>(i));
  }
  for (const auto& [tile, cells] : by_tile) {
    Piece<D> piece;
    for (const std::uint32_t i : cells) {
      piece.keys.push_back(moments[i].key);
      piece.moments.push_back(moments[i].moments);
    }
    pieces_[tile].push_back(file_.append(piece.bytes()));
  }
}

template <int D>
void SpilledCells<D>::add(const MapScale<D>& cells, const std::vector<double>& areas) {
  const std::int32_t span = tileSpan(options_);
  std::map<CellKey<D>, Piece<D>> by_tile;
  for (std::size_t cell = 0; cell < cells.keys.size(); ++cell) {
    Piece<D>& piece = by_tile[tileOf<D>(cells.keys[cell], span)];
    const IndexRange range = gaussiansOf(cells, cell);
    piece.keys.push_back(cells.keys[cell]);
    piece.counts.push_back(static_cast<std::uint32_t>(range.size()));
    for (std::size_t i = range.first; i < range.last; ++i) {
      piece.gaussians.push_back(cells.gaussians[i]);
      piece.areas.push_back(areas[i]);
    }
  }
  for (const auto& [tile, piece] : by_tile) pieces_[tile].push_back(file_.append(piece.bytes()));
}

template <int D>
std::vector<std::vector<CellKey<D>>> SpilledCells<D>::batches(std::size_t bytes) const {
  std::vector<std::vector<CellKey<D>>> batches;
  std::uint64_t held = 0;
  for (const auto& [tile, spans] : pieces_) {
    std::uint64_t size = 0;
    for (const SpillFile::Span& span : spans) size += span.size;
    if (batches.empty() || held + size > bytes) {
      batches.emplace_back();
      held = 0;
    }
    batches.back().push_back(tile);
    held += size;
  }
  return batches;
}

template <int D>
CellBatch<D> SpilledCells<D>::load(const std::vector<CellKey<D>>& tiles, int threads) {
  std::vector<Piece<D>> pieces(tiles.size());
  parallelFor(tiles.size(), threads, 1, [&](std::size_t i) {
    for (const SpillFile::Span& span : pieces_.at(tiles[i])) pieces[i].append(file_.read(span));
    if (pieces_.at(tiles[i]).size() > 1 && scale_ == 0) pieces[i] = withEachCellOnce(pieces[i]);
  });
  CellBatch<D> batch;
  MapScaleBuilder<D> cells;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    std::vector<SpillFile::Span>& spans = pieces_.at(tiles[i]);
    if (spans.size() > 1 && scale_ == 0) spans = {file_.append(pieces[i].bytes())};
    appendInOrder(cells, batch.areas, pieces[i], options_, scale_);
    batch.tiles.push_back(tiles[i]);
    batch.tile_end.push_back(cells.cells());
    pieces[i] = {};
  }
  batch.cells = cells.take();
  return batch;
}

template class SpilledCells<2>;
template class SpilledCells<3>;

}  // namespace gaussmap::detail
