// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/moment_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "core/check.h"
#include "core/function_clones.h"
#include "core/huge_pages.h"
#include "core/parallel.h"
#include "map/add_runs.h"
#include "map/lattice.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kBlock = PointBlock<3>::kCapacity;
constexpr std::size_t kFirstSlots = 1024;

/// Returns true if the hash table needs more slots. The maximum load is 1/4 while the table fits in the second-level
/// cache and 5/8 above. In fuller tables, probes become long and their ends hard to predict. In large tables, an
/// additional page or cache line costs time as well.
bool isFull(std::size_t cells, std::size_t slots) {
  constexpr std::size_t kRoomySlots = std::size_t{1} << 17;
  return slots <= kRoomySlots ? cells * 4 >= slots : cells * 8 >= slots * 5;
}

/// Rounds one axis of a block to the lattice. Returns 0 if every coordinate fits.
GAUSSMAP_CLONES std::uint64_t snapAxis(const double* coordinates, std::size_t size, double steps_per_metre,
                                       std::int32_t* cell, std::int32_t* offset) {
  alignas(64) double shifted[kBlock];
  alignas(64) std::int64_t bits[kBlock];
  for (std::size_t i = 0; i < size; ++i) shifted[i] = coordinates[i] * steps_per_metre + kSnap;
  std::memcpy(bits, shifted, size * sizeof(double));
  std::uint64_t misfits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::int64_t lattice = latticeFromBits(bits[i]);
    misfits |= misfitsLattice(lattice);
    cell[i] = cellOfLattice(lattice);
    offset[i] = offsetOfLattice(lattice);
  }
  return misfits;
}

/// One step of the hash of a key. The hash has 32 bits, so it can be computed in vector registers.
inline std::uint32_t mix(std::uint32_t hash, std::int32_t coordinate) {
  hash = (hash ^ static_cast<std::uint32_t>(coordinate)) * 0x9E3779B1u;
  return hash ^ (hash >> 15);
}
inline std::uint32_t finish(std::uint32_t hash) {
  hash *= 0x85EBCA77u;
  return hash ^ (hash >> 13);
}

template <int D>
std::uint32_t hashOf(const CellKey<D>& key) {
  std::uint32_t hash = 0;
  for (std::int32_t coordinate : key) hash = mix(hash, coordinate);
  return finish(hash);
}

GAUSSMAP_CLONES void mixAxis(const std::int32_t* cell, std::size_t size, std::uint32_t* hash) {
  for (std::size_t i = 0; i < size; ++i) hash[i] = mix(hash[i], cell[i]);
}
GAUSSMAP_CLONES void finishAll(std::size_t size, std::uint32_t* hash) {
  for (std::size_t i = 0; i < size; ++i) hash[i] = finish(hash[i]);
}

/// Sets begins[i] to 1 if point i lies in another cell than point i - 1, else to 0. begins[0] is 1.
template <int D>
GAUSSMAP_CLONES void findBegins(const std::int32_t (*cell)[kBlock], std::size_t size, std::uint32_t* begins) {
  begins[0] = 1;
  for (std::size_t i = 1; i < size; ++i) {
    std::int32_t differ = 0;
    for (int axis = 0; axis < D; ++axis) differ |= cell[axis][i] ^ cell[axis][i - 1];
    begins[i] = differ != 0;
  }
}

/// The points of a block, rounded to the lattice: integers only.
template <int D>
struct LatticeBlock {
  std::size_t size = 0;
  alignas(64) std::int32_t cell[D][kBlock];
  alignas(64) std::int32_t offset[D][kBlock];  // from the cell's centre [steps]
  alignas(64) std::uint32_t hash[kBlock];
  alignas(64) std::uint32_t begins[kBlock];  // 1 if the point before lies in another cell, else 0

  /// Rounds a block to the lattice. Returns true if every point is finite and in range.
  bool snap(const PointBlock<D>& block, double resolution) {
    size = block.size;
    const double steps_per_metre = stepsPerMetre(resolution);
    std::uint64_t misfits = 0;
    for (int axis = 0; axis < D; ++axis)
      misfits |= snapAxis(block.coordinate[axis], size, steps_per_metre, cell[axis], offset[axis]);
    if (misfits != 0) return false;
    std::memset(hash, 0, size * sizeof hash[0]);
    for (int axis = 0; axis < D; ++axis) mixAxis(cell[axis], size, hash);
    finishAll(size, hash);
    findBegins<D>(cell, size, begins);
    return true;
  }

  CellKey<D> key(std::size_t i) const {
    CellKey<D> key;
    for (std::size_t axis = 0; axis < D; ++axis) key[axis] = cell[axis][i];
    return key;
  }
};

/// Compares two keys without the call of memcmp() that operator== of std::array makes.
template <int D>
bool same(const CellKey<D>& a, const CellKey<D>& b) {
  std::int32_t difference = 0;
  for (std::size_t axis = 0; axis < D; ++axis) difference |= a[axis] ^ b[axis];
  return difference == 0;
}

/// Returns the finite points of a block.
template <int D>
PointBlock<D> finitePart(const PointBlock<D>& block) {
  PointBlock<D> finite;
  for (std::size_t i = 0; i < block.size; ++i) {
    bool good = true;
    for (int axis = 0; axis < D; ++axis) good &= std::isfinite(block.coordinate[axis][i]);
    if (!good) continue;
    for (int axis = 0; axis < D; ++axis) finite.coordinate[axis][finite.size] = block.coordinate[axis][i];
    ++finite.size;
  }
  return finite;
}

template <int D>
[[noreturn]] void throwFirstOutside(const PointBlock<D>& block, double resolution) {
  double point[D] = {};
  for (std::size_t i = 0; i < block.size; ++i) {
    std::uint64_t misfits = 0;
    for (int axis = 0; axis < D; ++axis) {
      point[axis] = block.coordinate[axis][i];
      misfits |= misfitsLattice(snap(point[axis] * stepsPerMetre(resolution)));
    }
    if (misfits != 0) break;
  }
  throwOutsideLattice(point, D, resolution);
}

/// Throws std::length_error if the block would give a cell too many points.
template <int D>
void requireRoom(const MomentGrid<D>& grid, const LatticeBlock<D>& block, const std::uint32_t* starts,
                 std::size_t runs) {
  for (std::size_t run = 0; run < runs; ++run) {
    const CellKey<D> key = block.key(starts[run]);
    const CellMoments<D>* known = grid.find(key);
    if (known == nullptr || known->count <= CellMoments<D>::kMaxPoints - std::int64_t{kBlock}) continue;
    std::int64_t more = 0;
    for (std::size_t i = 0; i < block.size; ++i) more += same<D>(block.key(i), key);
    known->requireRoom(more);
  }
}

}  // namespace

template <int D>
MomentGrid<D>::MomentGrid(double resolution) : resolution_(resolution) {
  require(std::isfinite(resolution) && resolution > 0.0, "resolution", resolution,
          "the side of a cell must be a positive number of metres");
  reserve(0);
}

template <int D>
std::size_t MomentGrid<D>::add(const PointBlock<D>& block) {
  LatticeBlock<D> lattice;
  if (!lattice.snap(block, resolution_)) {
    const PointBlock<D> finite = finitePart<D>(block);
    if (finite.size == block.size) throwFirstOutside<D>(block, resolution_);
    return add(finite);
  }

  // Consecutive points of a scan often lie in the same cell. Such a run needs one look-up. The look-ups of a block take
  // three passes. Each pass prefetches the memory that the next pass needs.
  std::uint32_t starts[kBlock + 1];
  std::size_t runs = 0;
  const std::size_t mask = slot_count_ - 1;  // if the table grows below, candidates are outdated but not wrong
  for (std::size_t i = 0; i < lattice.size; ++i) {
    __builtin_prefetch(&slots_[lattice.hash[i] & mask]);
    starts[runs] = static_cast<std::uint32_t>(i);
    runs += lattice.begins[i];
  }
  starts[runs] = static_cast<std::uint32_t>(lattice.size);
  if (point_count_ > CellMoments<D>::kMaxPoints - std::int64_t{kBlock}) requireRoom(*this, lattice, starts, runs);
  std::uint32_t candidates[kBlock];
  for (std::size_t run = 0; run < runs; ++run) {
    candidates[run] = candidate(lattice.hash[starts[run]]);
    if (candidates[run] != kEmpty) prefetch(cell(candidates[run]));
  }
  CellMoments<D>* cells[kBlock];
  for (std::size_t run = 0; run < runs; ++run) {
    const CellKey<D> key = lattice.key(starts[run]);
    const bool known = candidates[run] != kEmpty && same<D>(cell(candidates[run]).key, key);
    cells[run] = &(known ? cell(candidates[run]) : findOrInsert(key, lattice.hash[starts[run]])).moments;
  }
  addRuns({lattice.offset, starts, runs, cells});
  point_count_ += static_cast<std::int64_t>(lattice.size);
  return block.size;
}

template <int D>
void MomentGrid<D>::add(const CellKey<D>& key, const CellMoments<D>& moments) {
  findOrInsert(key, hashOf<D>(key)).moments += moments;
  point_count_ += moments.count;
}

template <int D>
const CellMoments<D>* MomentGrid<D>::find(const CellKey<D>& key) const {
  const std::uint32_t index = indexOf(key, hashOf<D>(key));
  return index == kEmpty ? nullptr : &(*this)[index].moments;
}

template <int D>
std::uint32_t MomentGrid<D>::indexOf(const CellKey<D>& key, std::uint32_t hash) const {
  const std::size_t mask = slot_count_ - 1;
  for (std::size_t position = hash & mask; slots_[position].index != kEmpty; position = (position + 1) & mask) {
    const Slot slot = slots_[position];
    if (slot.hash == hash && same<D>((*this)[slot.index].key, key)) return slot.index;
  }
  return kEmpty;
}

template <int D>
std::uint32_t MomentGrid<D>::candidate(std::uint32_t hash) const {
  const std::size_t mask = slot_count_ - 1;
  std::size_t position = hash & mask;
  while (slots_[position].hash != hash && slots_[position].index != kEmpty) position = (position + 1) & mask;
  return slots_[position].index;
}

template <int D>
void MomentGrid<D>::prefetch(const Cell& cell) {
  const char* const begin = reinterpret_cast<const char*>(&cell);
  __builtin_prefetch(begin, 1);
  __builtin_prefetch(begin + sizeof(Cell) - 1, 1);
}

template <int D>
void MomentGrid<D>::merge(const MomentGrid& other, int threads) {
  if (other.resolution_ != resolution_) {
    std::ostringstream text;
    text << "cells of " << resolution_ << " m and of " << other.resolution_
         << " m cannot be added: both grids need the same resolution";
    throw std::invalid_argument(text.str());
  }
  // The cells of the other grid differ, so the threads add to different cells of this grid. No cell is inserted
  // meanwhile. As in add(block), the memory is prefetched before the look-ups of a batch need it.
  constexpr std::size_t kBatch = 64;
  std::vector<std::uint64_t> unknown((other.size() + kBatch - 1) / kBatch);  // one bit per cell
  parallelFor(unknown.size(), threads, 64, [&](std::size_t batch) {
    const std::size_t first = batch * kBatch, count = std::min(kBatch, other.size() - first), mask = slot_count_ - 1;
    std::uint32_t hash[kBatch];
    for (std::size_t i = 0; i < count; ++i) {
      hash[i] = hashOf<D>(other[first + i].key);
      __builtin_prefetch(&slots_[hash[i] & mask]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t index = candidate(hash[i]);
      if (index != kEmpty) prefetch(cell(index));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t known = indexOf(other[first + i].key, hash[i]);
      if (known != kEmpty)
        cell(known).moments += other[first + i].moments;
      else
        unknown[batch] |= std::uint64_t{1} << i;
    }
  });
  std::vector<std::size_t> places(unknown.size());  // per batch: index of its first new cell
  std::size_t total = size_;
  for (std::size_t batch = 0; batch < unknown.size(); ++batch) {
    places[batch] = total;
    total += static_cast<std::size_t>(__builtin_popcountll(unknown[batch]));
  }
  reserve(total);
  std::vector<std::uint32_t> hashes(total - size_);
  parallelFor(unknown.size(), threads, 64, [&](std::size_t batch) {
    std::size_t place = places[batch];
    for (std::uint64_t bits = unknown[batch]; bits != 0; bits &= bits - 1, ++place) {
      const Cell& source = other[batch * kBatch + static_cast<std::size_t>(__builtin_ctzll(bits))];
      hashes[place - size_] = hashOf<D>(source.key);
      new (&cell(static_cast<std::uint32_t>(place))) Cell(source);
    }
  });
  for (std::size_t first = 0; first < hashes.size(); first += kBatch) {
    const std::size_t last = std::min(first + kBatch, hashes.size());
    for (std::size_t i = first; i < last; ++i) __builtin_prefetch(&slots_[hashes[i] & (slot_count_ - 1)], 1);
    for (std::size_t i = first; i < last; ++i) enter(hashes[i]);
  }
  point_count_ += other.point_count_;
}

template <int D>
typename MomentGrid<D>::Cell& MomentGrid<D>::findOrInsert(const CellKey<D>& key, std::uint32_t hash) {
  const std::uint32_t known = indexOf(key, hash);
  if (known != kEmpty) return cell(known);
  reserve(size_ + 1);
  Cell* const fresh = new (&cell(static_cast<std::uint32_t>(size_))) Cell{key, {}};
  enter(hash);
  return *fresh;
}

template <int D>
void MomentGrid<D>::enter(std::uint32_t hash) {
  const std::size_t mask = slot_count_ - 1;
  std::size_t position = hash & mask;
  while (slots_[position].index != kEmpty) position = (position + 1) & mask;
  slots_[position] = {hash, static_cast<std::uint32_t>(size_++)};
}

template <int D>
void MomentGrid<D>::reserve(std::size_t cells) {
  if (cells > kEmpty) throw std::length_error("more than 2^32 - 1 occupied cells: use coarser cells");
  while (chunks_.size() * kChunk < cells)
    chunks_.emplace_back(static_cast<Cell*>(allocatePages(kChunk * sizeof(Cell))));
  std::size_t slot_count = std::max(slot_count_, kFirstSlots);
  while (isFull(cells, slot_count)) slot_count *= 2;
  if (slot_count > slot_count_) widen(slot_count);
}

template <int D>
void MomentGrid<D>::widen(std::size_t slot_count) {
  std::unique_ptr<Slot[], Free> wider(static_cast<Slot*>(allocatePages(slot_count * sizeof(Slot))));
  std::uninitialized_fill_n(wider.get(), slot_count, Slot{0, kEmpty});
  const std::size_t mask = slot_count - 1;
  for (std::size_t i = 0; i < slot_count_; ++i) {
    if (slots_[i].index == kEmpty) continue;
    std::size_t position = slots_[i].hash & mask;
    while (wider[position].index != kEmpty) position = (position + 1) & mask;
    wider[position] = slots_[i];
  }
  slots_ = std::move(wider);
  slot_count_ = slot_count;
}

template <int D>
std::size_t MomentGrid<D>::memoryBytes() const {
  return size_ * sizeof(Cell) + slot_count_ * sizeof(Slot);
}

template class MomentGrid<2>;
template class MomentGrid<3>;

}  // namespace gaussmap
