// SPDX-License-Identifier: BSD-3-Clause
#include "map/add_runs.h"

#include <gtest/gtest.h>

#include <vector>

namespace gaussmap {
using namespace detail;

namespace {

TEST(AddRuns, EqualsThePlainLoopForExtremeAndRandomOffsetsAndSharedCells) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::int32_t offset[3][PointBlock<3>::kCapacity];
    const std::size_t points = 1 + random.below(PointBlock<3>::kCapacity);
    for (auto& axis : offset)
      for (std::int32_t& value : axis)
        value = random.below(8) == 0 ? (random.below(2) ? 32767 : -32768) : std::int32_t(random.below(65536)) - 32768;
    std::vector<CellMoments<3>> fast(7), plain(7);
    std::vector<std::uint32_t> starts;
    std::vector<CellMoments<3>*> fast_cells, plain_cells;
    for (std::size_t i = 0; i < points; i += 1 + random.below(4)) {
      starts.push_back(static_cast<std::uint32_t>(i));
      const std::size_t cell = random.below(7);
      fast_cells.push_back(&fast[cell]);
      plain_cells.push_back(&plain[cell]);
    }
    starts.push_back(static_cast<std::uint32_t>(points));
    addRuns(Runs<3>{offset, starts.data(), fast_cells.size(), fast_cells.data()});
    addRunsPlainly(Runs<3>{offset, starts.data(), plain_cells.size(), plain_cells.data()});
    EXPECT_EQ(fast, plain);
  }
}

}  // namespace
}  // namespace gaussmap
