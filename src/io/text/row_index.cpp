// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/row_index.h"

#include <charconv>
#include <string>
#include <system_error>

#include "io/files/text.h"

namespace gaussmap::detail {

std::size_t addRows(const RowParser& parser, TextPlace& place, std::size_t rows, RowIndex& index) {
  RowBlock block{0, index.marks.size()};
  while (block.rows < rows && parser.findRow(place)) {
    if (block.rows % RowIndex::kRowsPerMark == 0) index.marks.push_back(place);
    ++block.rows;
    parser.skipLine(place);
  }
  index.blocks.push_back(block);
  return block.rows;
}

void addCountedRows(const RowParser& parser, TextPlace place, const char* end, RowIndex& index) {
  constexpr std::size_t kLongestNumber = 80;  // characters that are looked at
  std::size_t last_line = 0;
  std::size_t count = 0;
  while (parser.findRow(place)) {
    const std::size_t line = place.line;
    std::string_view rest(place.at, static_cast<std::size_t>(end - place.at));
    const std::vector<std::string_view> words = splitWords(takeLine(rest).substr(0, kLongestNumber));
    const std::string_view word = words.front();
    const auto [word_end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    if (words.size() > 1 && last_line != 0)
      parser.fail(line, "more rows than the " + std::to_string(index.blocks.back().rows) + " points of line " +
                            std::to_string(last_line) + ": correct the number, or delete line " +
                            std::to_string(last_line) + " if the file has only one scan");
    if (words.size() > 1 || error != std::errc() || word_end != word.data() + word.size())
      parser.fail(line, quote(word) + " is not the number of points of the rows below it");
    // The shortest row is "1 2 3" with a line end.
    if (count > rest.size() / 6 + 1)
      parser.fail(line, std::to_string(count) + " points do not fit in the " + std::to_string(rest.size()) +
                            " bytes that follow");
    parser.skipLine(place);
    const std::size_t found = addRows(parser, place, count, index);
    if (found < count)
      parser.fail(place.line, "the file ends after " + std::to_string(found) + " of the " + std::to_string(count) +
                                  " points of line " + std::to_string(line) +
                                  ": the file is cut off, or the number is wrong");
    last_line = line;
    if (index.blocks.size() > kMostScans)
      parser.fail(line, "more than " + std::to_string(kMostScans) + " scans: is this a PTS file?");
    // Empty blocks would need more memory than text.
    if (count == 0 && (index.blocks.size() > 1 || parser.findRow(place)))
      parser.fail(line, "a scan with 0 points: delete this line");
  }
}

void readRows(const RowParser& parser, const RowIndex& index, const RowBlock& block, std::size_t first,
              std::size_t count, const std::vector<WantedColumn>& wanted) {
  if (count == 0) return;
  const TextPlace mark = index.marks[block.first_mark + first / RowIndex::kRowsPerMark];
  parser.parseRows(mark, first % RowIndex::kRowsPerMark, count, wanted);
}

}  // namespace gaussmap::detail
