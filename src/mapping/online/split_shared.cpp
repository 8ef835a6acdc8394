// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mapping/moving/object_rules.h"
#include "mapping/online/online_state.h"

namespace gaussmap::detail {
namespace {

/// A cell beside a deleted object.
struct CellBesideObject {
  std::uint32_t first_scan, last_scan;  // first and last scan that may have seen the object in the cell
  float log_odds;                       // of the object
};
using CellsBesideObjects =
    std::map<std::uint32_t, CellBesideObject>;  // a std::map, because the result depends on the order of the cells

template <int D>
CellsBesideObjects cellsBeside(const OnlineCells<D>& cells, const std::vector<GoneCell<D>>& gone) {
  CellsBesideObjects shared;
  for (const GoneCell<D>& cell : gone)
    noteSharedCells(FinestOnlineCells<D>{cells}, cell.key,
                    CellBesideObject{cell.evidence.first_hit, cell.evidence.last_hit, cell.log_odds}, shared);
  return shared;
}

template <int D>
class SharedCellSplitter {
 public:
  SharedCellSplitter(OnlineCells<D>& cells, const std::deque<ScanSums<D>>& recent, const OnlineOptions& options,
                     CellsBesideObjects shared)
      : cells_(cells), recent_(recent), options_(options), side_(cells.grid().side(0)), shared_(std::move(shared)) {}

  const CellsBesideObjects& shared() const { return shared_; }

  /// Calls body(scan, sums) for the recent scans that may have seen the object and have points in this cell. `sums` =
  /// moments of these points.
  template <typename Body>
  void forScans(std::uint32_t cell, const CellBesideObject& of, const Body& body) const {
    for (const ScanSums<D>& scan : recent_) {
      if (scan.number < of.first_scan || scan.number > of.last_scan) continue;
      const CellMoments<D>* sums = scan.sums.find(cells_.cell(cell, 0).key);
      if (sums != nullptr && sums->count > 0) body(scan, *sums);
    }
  }

  /// Returns the moments of a cell without the points of the scans that may have seen the object.
  CellMoments<D> still(std::uint32_t cell) const {
    CellMoments<D> moments = cells_.moments(cell);
    const auto entry = shared_.find(cell);
    if (entry != shared_.end())
      forScans(cell, entry->second, [&](const ScanSums<D>&, const CellMoments<D>& sums) { moments -= sums; });
    return moments;
  }

  /// Returns the numbers of the scans whose points in the cell lie off its surface.
  std::vector<std::uint32_t> scansOff(std::uint32_t cell, const CellBesideObject& of) const {
    std::vector<std::uint32_t> off;
    bool seen = false;
    forScans(cell, of, [&](const ScanSums<D>&, const CellMoments<D>&) { seen = true; });
    if (!seen || still(cell).count == 0) return off;
    const std::optional<Surface<D>> surface = surfaceAt(
        FinestOnlineCells<D>{cells_}, cell, [&](std::uint32_t near) { return still(near); }, options_.shared);
    if (!surface) return off;
    forScans(cell, of, [&](const ScanSums<D>& scan, const CellMoments<D>& sums) {
      const double away = surface->normal.dot(sums.mean(side_) - surface->point);
      const double across = surface->normal.dot(sums.covariance(side_) * surface->normal);
      if (std::sqrt(across + away * away) > surface->thickness(options_.shared)) off.push_back(scan.number);
    });
    return off;
  }

 private:
  const OnlineCells<D>& cells_;
  const std::deque<ScanSums<D>>& recent_;
  const OnlineOptions& options_;
  const double side_;
  const CellsBesideObjects shared_;
};

/// Removes the moments of a cell from the stored moments of a scan, and returns them.
template <int D>
CellMoments<D> takeFrom(MomentGrid<D>& scan, const CellKey<D>& key) {
  const CellMoments<D>* found = scan.find(key);
  if (found == nullptr) return {};
  const CellMoments<D> taken = *found;
  CellMoments<D> less;
  less -= taken;
  scan.add(key, less);
  return taken;
}

/// Removes the points of these scans from a cell, and returns their moments.
template <int D>
CellMoments<D> takeOut(OnlineCells<D>& cells, std::uint32_t cell, const std::vector<std::uint32_t>& scans,
                       std::deque<ScanSums<D>>& recent) {
  CellMoments<D> taken;
  for (ScanSums<D>& scan : recent)
    if (std::binary_search(scans.begin(), scans.end(), scan.number))
      taken += takeFrom<D>(scan.sums, cells.cell(cell, 0).key);
  cells.moments(cell) -= taken;
  const Grid<D>& grid = cells.grid();
  cells.cell(cell, 0).clusters[0].gaussian = cells.moments(cell).gaussian(grid.side(0), grid.options().noise);
  if (cells.scales() > 1) cells.markStale(cells.cell(cell, 0).parent, 1);
  return taken;
}

}  // namespace

template <int D>
void splitSharedCells(OnlineCells<D>& cells, const OnlineScan<D>& scan, const std::vector<GoneCell<D>>& gone,
                      std::deque<ScanSums<D>>& recent, const OnlineOptions& options,
                      const typename OnlineMapper<D>::Removed& removed, OnlineStatistics& statistics) {
  if (gone.empty() || recent.empty()) return;
  for (ScanSums<D>& seen : recent)  // if the cell is created again, it will not contain these points
    for (const GoneCell<D>& cell : gone) takeFrom<D>(seen.sums, cell.key);
  const SharedCellSplitter<D> splitter(cells, recent, options, cellsBeside(cells, gone));
  std::map<std::uint32_t, std::vector<std::uint32_t>> off;  // computed for all cells before the map changes
  for (const auto& [cell, shared] : splitter.shared()) {
    std::vector<std::uint32_t> scans = splitter.scansOff(cell, shared);
    if (!scans.empty()) off.emplace(cell, std::move(scans));
  }
  const Grid<D>& grid = cells.grid();
  for (const auto& [cell, scans] : off) {
    const CellMoments<D> taken = takeOut(cells, cell, scans, recent);
    ++statistics.deleted;
    if (!removed) continue;
    const CellKey<D> key = cells.cell(cell, 0).key;
    RemovedCluster<D> part{0, taken.gaussian(grid.side(0), grid.options().noise), key, taken, 0.0, {}, scan.number};
    part.gaussian.mean += grid.centre(key, 0);
    part.log_odds = double(splitter.shared().at(cell).log_odds);
    for (const std::uint32_t number : scans) part.evidence.hit(number);
    removed(part);
  }
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                        \
  template void splitSharedCells<D>(OnlineCells<D>&, const OnlineScan<D>&, const std::vector<GoneCell<(D)>>&,          \
                                    std::deque<ScanSums<(D)>>&, const OnlineOptions&, const OnlineMapper<D>::Removed&, \
                                    OnlineStatistics&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
