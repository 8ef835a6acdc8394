// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/cloud_text.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/text/ptx.h"
#include "io/text/row_index.h"
#include "io/text/text_head.h"
#include "io/text/text_layout.h"
#include "io/text/text_rows.h"

namespace gaussmap::detail {
namespace {

/// A text that is open: everything that its readers share.
struct OpenText {
  std::filesystem::path path;
  std::shared_ptr<const MappedFile> file;
  TextHead head;
  RowIndex index;
  PointLayout layout;

  const char* end() const { return file->bytes().data() + file->bytes().size(); }
  RowParser parser() const { return {path, end(), head.separator, head.columns}; }
};

/// Reads rows that are spread over the file.
std::vector<ColumnSample> sampleColumns(const RowParser& parser, const OpenText& text) {
  constexpr std::size_t kRuns = 32;
  constexpr std::size_t kRowsPerRun = 32;
  std::vector<ColumnSample> samples(text.head.columns);
  const std::vector<RowBlock>& blocks = text.index.blocks;
  const std::size_t marks = text.index.marks.size();
  auto block = blocks.begin();
  std::size_t last_mark = marks;
  for (std::size_t run = 0; run < std::min(kRuns, marks); ++run) {
    const std::size_t mark = marks <= kRuns ? run : run * (marks - 1) / (kRuns - 1);
    if (mark == last_mark) continue;
    last_mark = mark;
    while (block + 1 != blocks.end() && block[1].first_mark <= mark) ++block;
    const std::size_t first = (mark - block->first_mark) * RowIndex::kRowsPerMark;
    TextPlace place = text.index.marks[mark];
    for (std::size_t i = 0; i < std::min(kRowsPerRun, block->rows - first) && parser.findRow(place); ++i) {
      TextPlace next = place;
      parser.parse(next, {}, 0);  // checks the number of columns
      std::string_view row(place.at, static_cast<std::size_t>(next.at - place.at));
      std::vector<std::string_view> words = splitRow(takeLine(row), text.head.separator);
      words.resize(samples.size());  // the last column can be empty
      for (std::size_t column = 0; column < samples.size(); ++column) {
        double value = std::numeric_limits<double>::quiet_NaN();
        ColumnSample& sample = samples[column];
        if (!parseCell(words[column], value) && sample.numeric) {
          sample.numeric = false;
          sample.text = words[column];
          sample.text_line = place.line;
        }
        sample.values.push_back(value);
      }
      place = next;
    }
  }
  return samples;
}

class TextReader : public ScanReader {
 public:
  TextReader(std::shared_ptr<const OpenText> text, const RowBlock& block) : text_(std::move(text)), block_(block) {}

  std::size_t size() const override { return block_.rows; }

  void read(std::size_t first, PointBlock<3>& block) const override {
    block.size = first < size() ? std::min(size() - first, PointBlock<3>::kCapacity) : 0;
    const PointLayout& layout = text_->layout;
    std::vector<WantedColumn> wanted;
    for (std::size_t axis = 0; axis < 3; ++axis) wanted.push_back({layout.coordinates[axis], block.coordinate[axis]});
    readColumns(first, block.size, std::move(wanted));
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (const double divisor = layout.divisors[axis]; divisor != 1.0)
        for (std::size_t i = 0; i < block.size; ++i) block.coordinate[axis][i] /= divisor;
  }
  void requireWhole() const override { text_->file->requireWhole(); }

  std::vector<std::string> valueNames() const override {
    std::vector<std::string> names;
    for (const PointValue& value : text_->layout.values) names.push_back(value.name);
    return names;
  }
  std::vector<double> values(const std::string& name) const override {
    for (const PointValue& value : text_->layout.values) {
      if (value.name != name) continue;
      std::vector<std::vector<double>> columns(value.columns.size(), std::vector<double>(size()));
      std::vector<WantedColumn> wanted;
      for (std::size_t i = 0; i < columns.size(); ++i) wanted.push_back({value.columns[i], columns[i].data()});
      readColumns(0, size(), std::move(wanted));
      return makeValue(text_->path, value, std::move(columns));
    }
    return ScanReader::values(name);
  }

 private:
  void readColumns(std::size_t first, std::size_t count, std::vector<WantedColumn> wanted) const {
    std::sort(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) { return a.column < b.column; });
    readRows(text_->parser(), text_->index, block_, first, count, wanted);
  }

  std::shared_ptr<const OpenText> text_;
  RowBlock block_;
};

class CloudText : public ScanFile {
 public:
  explicit CloudText(std::shared_ptr<const OpenText> text) : text_(std::move(text)) {}

  std::string kind() const override {
    const TextHead& head = text_->head;
    const char* const separator = head.separator == ' '   ? "blanks"
                                  : head.separator == ',' ? "commas"
                                  : head.separator == ';' ? "semicolons"
                                                          : "tabs";
    const std::string columns =
        std::to_string(head.columns) + " columns" + (head.columns > 1 ? std::string(" separated by ") + separator : "");
    return head.counted ? "PTS text, " + columns : "text, " + columns;
  }
  std::size_t size() const override { return text_->index.blocks.size(); }
  FileScanInfo info(std::size_t scan) const override {
    const std::string name = size() > 1 ? "scan " + std::to_string(scan) : "";
    return {name, text_->index.blocks[scan].rows};
  }
  std::unique_ptr<ScanReader> open(std::size_t scan) const override {
    return std::make_unique<TextReader>(text_, text_->index.blocks[scan]);
  }
  std::size_t memoryOf(std::size_t) const override { return 0; }
  void releasePages() const override { text_->file->release(); }
  std::vector<std::string> warnings() const override { return text_->layout.warnings; }

 private:
  std::shared_ptr<const OpenText> text_;
};

/// Throws FileError if the bytes are certainly not a text that can be read.
void requireText(const std::filesystem::path& path, std::string_view bytes) {
  constexpr std::size_t kLooked = 4096;
  if (bytes.empty()) throw FileError(path, "the file is empty");
  const std::string_view two = bytes.substr(0, 2);
  if (two == "\xFF\xFE" || two == "\xFE\xFF") throw FileError(path, "is a text in UTF-16: save it as UTF-8");
  const std::string_view start = bytes.substr(0, kLooked);
  if (const std::size_t zero = start.find('\0'); zero != std::string_view::npos)
    throw FileError(path, "byte " + std::to_string(zero) + " is zero, so this is not a text");
}

}  // namespace

bool isCloudText(std::string_view start) {
  if (start.substr(0, kByteOrderMark.size()) == kByteOrderMark) start.remove_prefix(kByteOrderMark.size());
  for (const char c : start)
    if ((c >= '\0' && c < ' ' && c != '\t' && c != '\r' && c != '\n') || c == '\x7F') return false;
  if (isPtx(start)) return true;
  // The last line can be cut off.
  if (const std::size_t end = start.rfind('\n'); end != std::string_view::npos) start = start.substr(0, end + 1);
  try {
    const TextHead head = readTextHead("", start, {});
    return head.has_row ? head.columns >= 3 : !head.names.empty();
  } catch (const FileError&) {
    return false;
  }
}

std::unique_ptr<ScanFile> openCloudText(const std::filesystem::path& path, const CloudTextOptions& options) {
  std::vector<PointField> fields;
  if (!options.fields.empty()) fields = parseFields(options.fields, false);
  auto text = std::make_shared<OpenText>();
  text->path = path;
  text->file = std::make_shared<const MappedFile>(path);
  std::string_view bytes = text->file->bytes();
  requireText(path, bytes);
  if (bytes.substr(0, kByteOrderMark.size()) == kByteOrderMark) bytes.remove_prefix(kByteOrderMark.size());
  if (fields.empty() && isPtx(bytes)) return openPtx(path, text->file);
  text->head = readTextHead(path, bytes, fields);
  const RowParser parser(text->path, text->end(), text->head.separator, text->head.columns);
  if (text->head.counted) {
    addCountedRows(parser, text->head.body, text->end(), text->index);
  } else {
    TextPlace place = text->head.body;
    addRows(parser, place, std::numeric_limits<std::size_t>::max(), text->index);
  }
  text->layout = layOutText(text->path, text->head, sampleColumns(parser, *text), fields);
  return std::make_unique<CloudText>(std::move(text));
}

}  // namespace gaussmap::detail
