// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

// The layout of help texts, which writers of other formats need to know.
namespace gaussmap::app {

enum class BlockKind {
  Paragraph,
  Item,     ///< of a list: "- text"
  Term,     ///< "term  text", with two blanks at least between them
  Verbatim  ///< indented lines, kept as they are
};

/// A part of the details of a help text.
struct TextBlock {
  BlockKind kind = BlockKind::Paragraph;
  std::string term, text;
};

/// Lines of a paragraph, item or term are joined by blanks.
std::vector<TextBlock> blocksOf(const std::string& details);

/// A piece of a sentence: text, or the name of an option such as "--force".
struct TextPiece {
  bool is_option = false;
  std::string text;
};

std::vector<TextPiece> piecesOf(const std::string& sentence);

/// A full stop at the end, unless the text is empty or has one.
std::string withFullStop(std::string text);

/// Every `from` becomes `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace gaussmap::app
