// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/merge_gains.h"

#include <queue>

namespace gaussmap::detail {
namespace {

/// The merge of a cell that is undone next.
struct StandingMerge {
  double gain;
  std::size_t cell;
  /// For std::priority_queue: true if a is undone after b. Equal gains: the smaller index first.
  friend bool operator<(const StandingMerge& a, const StandingMerge& b) {
    return a.gain != b.gain ? a.gain < b.gain : a.cell > b.cell;
  }
};

}  // namespace

std::vector<double> mergeGains(const Dendrogram& dendrogram) {
  struct Block {
    double sum;
    std::size_t size;
    double mean() const { return sum / static_cast<double>(size); }
  };
  std::vector<Block> blocks;
  for (auto merge = dendrogram.merges.rbegin(); merge != dendrogram.merges.rend(); ++merge) {
    Block block{merge->cost, 1};
    for (; !blocks.empty() && blocks.back().mean() < block.mean(); blocks.pop_back())
      block = {blocks.back().sum + block.sum, blocks.back().size + block.size};
    blocks.push_back(block);
  }
  std::vector<double> gains;
  gains.reserve(dendrogram.merges.size());
  for (const Block& block : blocks) gains.insert(gains.end(), block.size, block.mean());
  return gains;
}

std::vector<std::size_t> partsPerCell(const std::vector<std::vector<double>>& gains, std::size_t extra) {
  std::vector<std::size_t> parts(gains.size(), 1);
  std::priority_queue<StandingMerge> queue;
  const auto enqueue = [&](std::size_t cell) {
    if (parts[cell] <= gains[cell].size()) queue.push({gains[cell][parts[cell] - 1], cell});
  };
  for (std::size_t cell = 0; cell < gains.size(); ++cell) enqueue(cell);
  for (; extra > 0 && !queue.empty(); --extra) {
    const std::size_t cell = queue.top().cell;
    queue.pop();
    ++parts[cell];
    enqueue(cell);
  }
  return parts;
}

}  // namespace gaussmap::detail
