// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/moment_grid.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "lattice.h"

namespace gaussmap {
namespace {

template <int D>
std::uint64_t hashOf(const CellKey<D>& key) {
  std::uint64_t hash = 0;
  for (std::size_t axis = 0; axis < D; ++axis)
    hash = (hash ^ static_cast<std::uint32_t>(key[axis])) * 0x9E3779B97F4A7C15ull + (hash >> 29);
  hash ^= hash >> 32;
  return hash * 0xD6E8FEB86659FD93ull;
}

constexpr int kBlock = int(PointBlock<3>::kCapacity);
constexpr std::size_t kFirstSlots = 1024;

/// A block on the lattice: what is left of the points is integers.
template <int D>
struct LatticeBlock {
  int size = 0;
  std::int32_t cell[D][kBlock];
  std::int32_t offset[D][kBlock];  // from the cell's centre [steps]
};

/// Snaps one axis; true if every coordinate was finite and in range. Written for the vectoriser: no branch, no call.
bool snapAxis(const double* coordinates, int size, double steps_per_metre, std::int32_t* cell, std::int32_t* offset) {
  int bad = 0;
  for (int i = 0; i < size; ++i) {
    const double steps = coordinates[i] * steps_per_metre;
    bad |= !(std::abs(steps) < kLatticeLimit);
    const std::int64_t lattice = snap(steps);
    // 48 bits of lattice coordinate: the upper 32 are the cell, the lower 16 the place in it.
    cell[i] = static_cast<std::int32_t>(static_cast<std::uint64_t>(lattice) >> 16);
    offset[i] = static_cast<std::int32_t>(lattice & 0xFFFF) - 0x8000;
  }
  return bad == 0;
}

template <int D>
bool isFinite(const PointBlock<D>& block, std::size_t i) {
  for (int axis = 0; axis < D; ++axis)
    if (!std::isfinite(block.coordinate[axis][i])) return false;
  return true;
}

/// The finite points of a block.
template <int D>
PointBlock<D> finitePart(const PointBlock<D>& block) {
  PointBlock<D> finite;
  for (std::size_t i = 0; i < block.size; ++i) {
    if (!isFinite<D>(block, i)) continue;
    for (int axis = 0; axis < D; ++axis) finite.coordinate[axis][finite.size] = block.coordinate[axis][i];
    ++finite.size;
  }
  return finite;
}

template <int D>
bool snapBlock(const PointBlock<D>& block, double steps_per_metre, LatticeBlock<D>& lattice) {
  lattice.size = static_cast<int>(block.size);
  bool good = true;
  for (int axis = 0; axis < D; ++axis)
    good &= snapAxis(block.coordinate[axis], lattice.size, steps_per_metre, lattice.cell[axis], lattice.offset[axis]);
  return good;
}

template <int D>
[[noreturn]] void throwFirstOutside(const PointBlock<D>& block, double resolution) {
  const double steps_per_metre = stepsPerMetre(resolution);
  double point[D] = {};
  for (std::size_t i = 0; i < block.size; ++i) {
    bool inside = true;
    for (int axis = 0; axis < D; ++axis) {
      point[axis] = block.coordinate[axis][i];
      inside &= std::abs(point[axis] * steps_per_metre) < kLatticeLimit;
    }
    if (!inside) break;
  }
  throwOutsideLattice(point, D, resolution);
}

}  // namespace

template <int D>
MomentGrid<D>::MomentGrid(double resolution) : resolution_(resolution), slots_(kFirstSlots, Slot{0, kEmpty}) {
  if (!(std::isfinite(resolution) && resolution > 0.0))
    throw std::invalid_argument("resolution = " + std::to_string(resolution) +
                                ": the side of a cell must be a positive number of metres");
}

template <int D>
std::size_t MomentGrid<D>::add(const PointBlock<D>& block) {
  LatticeBlock<D> lattice;
  if (!snapBlock<D>(block, stepsPerMetre(resolution_), lattice)) {
    const PointBlock<D> finite = finitePart<D>(block);
    if (finite.size == block.size) throwFirstOutside<D>(block, resolution_);
    return add(finite);
  }

  // Points of a scan come in runs of the same cell: each run costs one look-up. The look-ups of a block are made
  // in three passes, so that the memory they need is on its way while the passes before it work.
  struct Run {
    int first;
    std::uint64_t hash;
  };
  Run runs[kBlock + 1];
  int run_count = 0;
  const auto keyAt = [&lattice](int i) {
    CellKey<D> key;
    for (std::size_t axis = 0; axis < D; ++axis) key[axis] = lattice.cell[axis][i];
    return key;
  };
  for (int i = 0; i < lattice.size; ++i) {
    bool same = i > 0;
    for (int axis = 0; axis < D && same; ++axis) same = lattice.cell[axis][i] == lattice.cell[axis][i - 1];
    if (same) continue;
    const std::uint64_t hash = hashOf<D>(keyAt(i));
    __builtin_prefetch(&slots_[hash & (slots_.size() - 1)]);
    runs[run_count++] = {i, hash};
  }
  runs[run_count].first = lattice.size;
  for (int run = 0; run < run_count; ++run) {
    const std::uint32_t index = slots_[runs[run].hash & (slots_.size() - 1)].index;
    if (index == kEmpty) continue;
    const char* home = reinterpret_cast<const char*>(&cell(index));
    __builtin_prefetch(home, 1);
    __builtin_prefetch(home + sizeof(Cell) - 1, 1);
  }
  for (int run = 0; run < run_count; ++run) {
    CellMoments<D>& moments = findOrInsert(keyAt(runs[run].first), runs[run].hash).moments;
    CellMoments<D> sums = moments;
    for (int i = runs[run].first; i < runs[run + 1].first; ++i) {
      typename CellMoments<D>::Offset offset;
      for (std::size_t axis = 0; axis < D; ++axis) offset[axis] = lattice.offset[axis][i];
      sums.add(offset);
    }
    moments = sums;
  }
  point_count_ += lattice.size;
  return block.size;
}

template <int D>
void MomentGrid<D>::add(const CellKey<D>& key, const CellMoments<D>& moments) {
  findOrInsert(key, hashOf<D>(key)).moments += moments;
  point_count_ += moments.count;
}

template <int D>
void MomentGrid<D>::merge(const MomentGrid& other) {
  if (other.resolution_ != resolution_) {
    std::ostringstream text;
    text << "cells of " << resolution_ << " m and of " << other.resolution_ << " m cannot be added exactly";
    throw std::invalid_argument(text.str());
  }
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < other.size(); ++i) {
    if (i + kAhead < other.size())
      __builtin_prefetch(&slots_[hashOf<D>(other[i + kAhead].key) & (slots_.size() - 1)]);
    add(other[i].key, other[i].moments);
  }
}

template <int D>
typename MomentGrid<D>::Cell& MomentGrid<D>::findOrInsert(const CellKey<D>& key, std::uint64_t hash) {
  const auto tag = static_cast<std::uint32_t>(hash >> 32);
  std::size_t mask = slots_.size() - 1;
  std::size_t position = hash & mask;
  for (; slots_[position].index != kEmpty; position = (position + 1) & mask) {
    const Slot slot = slots_[position];
    if (slot.tag == tag && cell(slot.index).key == key) return cell(slot.index);
  }
  if (size_ * 4 >= slots_.size() * 3) {
    grow();
    return findOrInsert(key, hash);
  }
  if (size_ >= kEmpty) throw std::length_error("more than 2^32 - 1 occupied cells: take coarser cells");
  if (size_ % kChunk == 0) chunks_.push_back(std::make_unique<Cell[]>(kChunk));
  slots_[position] = {tag, static_cast<std::uint32_t>(size_)};
  Cell& fresh = cell(static_cast<std::uint32_t>(size_++));
  fresh.key = key;
  return fresh;
}

template <int D>
void MomentGrid<D>::grow() {
  std::vector<Slot> wider(slots_.size() * 2, Slot{0, kEmpty});
  const std::size_t mask = wider.size() - 1;
  for (std::size_t index = 0; index < size_; ++index) {
    const std::uint64_t hash = hashOf<D>((*this)[index].key);
    std::size_t position = hash & mask;
    while (wider[position].index != kEmpty) position = (position + 1) & mask;
    wider[position] = {static_cast<std::uint32_t>(hash >> 32), static_cast<std::uint32_t>(index)};
  }
  slots_ = std::move(wider);
}

template <int D>
std::size_t MomentGrid<D>::memoryBytes() const {
  return chunks_.size() * kChunk * sizeof(Cell) + slots_.capacity() * sizeof(Slot);
}

template class MomentGrid<2>;
template class MomentGrid<3>;

}  // namespace gaussmap
