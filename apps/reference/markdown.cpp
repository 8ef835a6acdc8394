// SPDX-License-Identifier: BSD-3-Clause
#include "reference/markdown.h"

#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

std::string code(const std::string& text) {
  return "`" + text + "`";
}

/// Escapes a text for Markdown. Names of options become code, because "--" in a text is printed as a dash.
std::string escaped(const std::string& text) {
  std::string markdown;
  for (const TextPiece& piece : piecesOf(text)) {
    if (piece.is_option) {
      markdown += code(piece.text);
      continue;
    }
    for (const char c : piece.text) {
      if (std::string("\\`*_<>|~$").find(c) != std::string::npos) markdown += '\\';
      markdown += c;
    }
  }
  return markdown;
}

/// Returns an escaped text for the cell of a table, which must be one line.
std::string textCell(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool is_blank = c == '\n' || c == ' ';
    if (!is_blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  return escaped(line);
}

/// Returns code for the cell of a table, where a bar would end the cell.
std::string codeCell(const std::string& text) {
  return text.empty() ? "" : code(replaced(text, "|", "\\|"));
}

std::string block(const std::string& text) {
  return "```text\n" + text + "\n```\n\n";
}

std::string optionTable(const OptionGroup& group) {
  std::string text = "| " + escaped(group.title) + " | Meaning | Default |\n|---|---|---|\n";
  for (const OptionEntry& option : group.options) {
    text += "| " + codeCell(optionText(option)) + " | " + textCell(option.description);
    if (option.is_required) text += " (required)";
    text += " | " + codeCell(option.default_value) + " |\n";
  }
  return text + "\n";
}

std::string positionalTable(const CommandEntry& command) {
  if (command.positionals.empty()) return "";
  std::string text = "| Argument | Meaning | Default |\n|---|---|---|\n";
  for (const OptionEntry& option : command.positionals)
    text += "| " + codeCell(optionText(option)) + " | " + textCell(option.description) + " | " +
            codeCell(option.default_value) + " |\n";
  return text + "\n";
}

std::string detailsText(const std::string& details) {
  std::string text;
  BlockKind last = BlockKind::Paragraph;
  for (const TextBlock& part : blocksOf(details)) {
    const bool is_list = part.kind == BlockKind::Item || part.kind == BlockKind::Term;
    if (last != part.kind && (last == BlockKind::Item || last == BlockKind::Term)) text += "\n";
    last = part.kind;
    if (part.kind == BlockKind::Verbatim) text += block(part.text);
    if (part.kind == BlockKind::Paragraph) text += escaped(part.text) + "\n\n";
    if (is_list) text += "- " + (part.term.empty() ? "" : code(part.term) + ": ") + escaped(part.text) + "\n";
  }
  return text.empty() || text.compare(text.size() - 2, 2, "\n\n") == 0 ? text : text + "\n";
}

std::string commandSection(const CommandEntry& command, const std::string& program) {
  const std::string name = program + " " + command.name;
  std::string text = "## " + name + "\n\n" + withFullStop(escaped(command.summary)) + "\n\n" +
                     block(name + " " + usageText(command)) + positionalTable(command);
  for (const OptionGroup& group : command.groups) text += optionTable(group);
  return text + detailsText(command.details) + "Example:\n\n" + block(command.example);
}

}  // namespace

std::string markdownReference(const ProgramTree& tree) {
  const std::string program = tree.program.name;
  std::string text =
      "# Command reference\n\n<!-- Written by the program, do not edit: " + program +
      " reference --markdown docs/commands.md --force -->\n\n" + withFullStop(escaped(tree.program.summary)) + "\n`" +
      program + " COMMAND --help` prints the common options of a command, `--help-all` everything that this page " +
      "says about it.\nUnits are in brackets, such as [m].\nThe exit code is 0 after success, 2 after wrong usage, and "
      "1 after any other error.\n\n| Command | Purpose |\n|---|---|\n";
  for (const CommandEntry& command : tree.commands)
    text += "| [" + command.name + "](#" + program + "-" + command.name + ") | " + escaped(command.summary) + " |\n";
  text += "\n";
  for (const OptionGroup& group : tree.program.groups) text += optionTable(group);
  text += "Example:\n\n" + block(tree.program.example);
  for (const CommandEntry& command : tree.commands) text += commandSection(command, program);
  text.pop_back();  // of two line ends
  return text;
}

}  // namespace gaussmap::app
