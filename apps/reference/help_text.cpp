// SPDX-License-Identifier: BSD-3-Clause
#include "reference/help_text.h"

#include <cctype>
#include <sstream>

namespace gaussmap::app {
namespace {

/// Returns where the text of "term  text" begins; npos if the line has no term.
std::size_t textAfterTerm(const std::string& line, std::size_t indent) {
  const std::size_t gap = line.find("  ", indent);
  return gap == std::string::npos ? std::string::npos : line.find_first_not_of(' ', gap);
}

/// Returns true for an indented line that begins below "one" of a paragraph "More examples: one". Then "one" and this
/// line are both separate lines.
bool continuesColumn(const TextBlock& block, std::size_t indent) {
  return block.kind == BlockKind::Paragraph && indent > 2 && indent < block.text.size() &&
         block.text.compare(indent - 2, 2, ": ") == 0;
}

class BlockReader {
 public:
  void read(const std::string& line) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos) {
      is_open_ = false;
      return;
    }
    const std::string body = line.substr(indent);
    const std::size_t text = textAfterTerm(line, indent);
    if (body.compare(0, 2, "- ") == 0) return open(BlockKind::Item, "", body.substr(2), indent + 2);
    if (text != std::string::npos)
      return open(BlockKind::Term, line.substr(indent, line.find("  ", indent) - indent), line.substr(text), text);
    if (is_open_ && (last().kind == BlockKind::Item || last().kind == BlockKind::Term) && indent >= hang_)
      return append(" " + body);
    if (indent > 0) return readVerbatim(body, indent);
    if (is_open_ && last().kind == BlockKind::Paragraph) return append(" " + body);
    open(BlockKind::Paragraph, "", body, 0);
  }

  std::vector<TextBlock> blocks;

 private:
  TextBlock& last() { return blocks.back(); }
  void open(BlockKind kind, const std::string& term, const std::string& text, std::size_t hang) {
    blocks.push_back({kind, term, text});
    hang_ = hang;
    is_open_ = true;
  }
  void append(const std::string& text) { last().text += text; }
  void readVerbatim(const std::string& body, std::size_t indent) {
    if (is_open_ && last().kind == BlockKind::Verbatim) return append("\n" + body);
    if (is_open_ && continuesColumn(last(), indent)) {
      const std::string above = last().text.substr(indent);
      last().text.resize(indent - 1);
      open(BlockKind::Verbatim, "", above, 0);
      return append("\n" + body);
    }
    open(BlockKind::Verbatim, "", body, 0);
  }

  std::size_t hang_ = 0;  // where the text of an item or term begins
  bool is_open_ = false;
};

bool isOptionStart(const std::string& text, std::size_t at) {
  if (text[at] != '-' || (at > 0 && std::string(" (['\"").find(text[at - 1]) == std::string::npos)) return false;
  const std::size_t letter = text.find_first_not_of('-', at);
  return letter != std::string::npos && letter - at <= 2 && std::isalpha(static_cast<unsigned char>(text[letter])) != 0;
}

bool isOptionLetter(char c) {
  return c == '-' || std::isalnum(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

std::vector<TextBlock> blocksOf(const std::string& details) {
  BlockReader reader;
  std::istringstream lines(details);
  for (std::string line; std::getline(lines, line);) reader.read(line);
  return std::move(reader.blocks);
}

std::vector<TextPiece> piecesOf(const std::string& sentence) {
  std::vector<TextPiece> pieces;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < sentence.size(); ++i) {
    if (!isOptionStart(sentence, i)) continue;
    if (i > begin) pieces.push_back({false, sentence.substr(begin, i - begin)});
    begin = i;
    while (i < sentence.size() && isOptionLetter(sentence[i])) ++i;
    pieces.push_back({true, sentence.substr(begin, i - begin)});
    begin = i--;
  }
  if (begin < sentence.size()) pieces.push_back({false, sentence.substr(begin)});
  return pieces;
}

std::string withFullStop(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) text += (i > 0 ? between : "") + words[i];
  return text;
}

}  // namespace gaussmap::app
