// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

// The layout of help texts. The writers of man pages and Markdown use it.
namespace gaussmap::app {

enum class BlockKind {
  Paragraph,
  Item,     ///< of a list: "- text"
  Term,     ///< "term  text", with at least two blanks between them
  Verbatim  ///< indented lines, kept as they are
};

/// A part of the details of a help text.
struct TextBlock {
  BlockKind kind = BlockKind::Paragraph;
  std::string term, text;
};

/// Splits the details of a help text into blocks. The lines of a paragraph, item or term are joined by blanks.
std::vector<TextBlock> blocksOf(const std::string& details);

/// A piece of a sentence: text, or the name of an option such as "--force".
struct TextPiece {
  bool is_option = false;
  std::string text;
};

/// Splits a sentence into names of options and the text between them.
std::vector<TextPiece> piecesOf(const std::string& sentence);

/// Adds a full stop if the text is not empty and does not end with one.
std::string withFullStop(std::string text);

/// Replaces every `from` by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// Joins words, with `between` between two of them.
std::string joined(const std::vector<std::string>& words, const std::string& between);

}  // namespace gaussmap::app
