// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/text/text_rows.h"

namespace gaussmap::detail {

/// Largest number of scans in a text. It limits the memory for files with very short scans.
inline constexpr std::size_t kMostScans = 65536;

/// A run of rows: one scan of a text.
struct RowBlock {
  std::size_t rows = 0;
  std::size_t first_mark = 0;  ///< place of its first row in RowIndex::marks
};

/// The places of every kRowsPerMark-th row, so that rows can be read in any order without keeping their numbers.
struct RowIndex {
  static constexpr std::size_t kRowsPerMark = 512;
  std::vector<TextPlace> marks;
  std::vector<RowBlock> blocks;
};

/// Adds a block of `rows` rows that start at `place`, and moves `place` behind them. Returns the number of rows that
/// the text really has; it is less than `rows` if the text ends.
std::size_t addRows(const RowParser& parser, TextPlace& place, std::size_t rows, RowIndex& index);

/// Adds blocks until the end of the text. Before each block stands the number of its rows, as in PTS. Throws FileError
/// if a number is wrong.
void addCountedRows(const RowParser& parser, TextPlace place, const char* end, RowIndex& index);

/// Reads the rows `first`, `first` + 1 ... of a block. The block must have them.
void readRows(const RowParser& parser, const RowIndex& index, const RowBlock& block, std::size_t first,
              std::size_t count, const std::vector<WantedColumn>& wanted);

}  // namespace gaussmap::detail
