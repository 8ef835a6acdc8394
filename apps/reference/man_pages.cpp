// SPDX-License-Identifier: BSD-3-Clause
#include "reference/man_pages.h"

#include <algorithm>
#include <sstream>

#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

constexpr std::size_t kSourceWidth = 78;

/// Escapes a text for roff. The hyphens of options become hyphens that can be copied.
std::string roffEscaped(const std::string& text) {
  std::string roff;
  for (const TextPiece& piece : piecesOf(replaced(text, "\\", "\\e")))
    roff += piece.is_option ? replaced(piece.text, "-", "\\-") : piece.text;
  return roff;
}

/// Returns a line of text that roff does not read as a macro.
std::string roffLine(const std::string& line) {
  return (!line.empty() && (line[0] == '.' || line[0] == '\'') ? "\\&" : "") + line + "\n";
}

/// Returns one argument of a macro.
std::string argument(const std::string& text) {
  const std::string roff = "\\&" + replaced(replaced(text, "\\", "\\e"), "\"", "\\(dq");
  return roff.find(' ') == std::string::npos ? roff : "\"" + roff + "\"";
}

/// Wraps a text. Every sentence starts on a new line, as mdoc(7) asks for.
std::string roffText(const std::string& text) {
  std::istringstream words(roffEscaped(text));
  std::string lines, line, word;
  while (words >> word) {
    if (line.size() + 1 + word.size() > kSourceWidth) lines += roffLine(line), line.clear();
    line += (line.empty() ? "" : " ") + word;
    if (word.size() > 2 && word.back() == '.') lines += roffLine(line), line.clear();
  }
  return line.empty() ? lines : lines + roffLine(line);
}

std::string roffVerbatim(const std::string& text) {
  std::istringstream lines(text);
  std::string roff = ".Bd -literal -offset indent\n";
  for (std::string line; std::getline(lines, line);) roff += roffLine(roffEscaped(line));
  return roff + ".Ed\n";
}

std::string roffDetails(const std::string& details) {
  std::string roff;
  BlockKind last = BlockKind::Paragraph;
  const auto isList = [](BlockKind kind) { return kind == BlockKind::Item || kind == BlockKind::Term; };
  for (const TextBlock& part : blocksOf(details)) {
    if (isList(last) && part.kind != last) roff += ".El\n";
    if (part.kind == BlockKind::Paragraph) roff += ".Pp\n" + roffText(part.text);
    if (part.kind == BlockKind::Verbatim) roff += roffVerbatim(part.text);
    if (isList(part.kind) && part.kind != last)
      roff += part.kind == BlockKind::Item ? ".Bl -bullet -compact\n" : ".Bl -tag -width Ds -compact\n";
    if (isList(part.kind))
      roff += ".It" + (part.term.empty() ? "" : " " + argument(part.term)) + "\n" + roffText(part.text);
    last = part.kind;
  }
  return isList(last) ? roff + ".El\n" : roff;
}

/// Returns the names of an option for .It or .Op, such as "Fl o , Fl -output Ar FILE".
std::string optionMacros(const OptionEntry& option) {
  std::string macros;
  for (const std::string& name : option.names)
    macros += (macros.empty() ? "" : " , ") + (name[0] == '-' ? "Fl " + name.substr(1) : "Ar " + name);
  const std::string value = valueText(option);
  return value.empty() || option.names.front()[0] != '-' ? macros : macros + " Ar " + argument(value);
}

std::string optionList(const std::vector<OptionEntry>& options) {
  std::string roff = ".Bl -tag -width Ds\n";
  for (const OptionEntry& option : options) {
    roff += ".It " + optionMacros(option) + "\n" + roffText(withFullStop(option.description));
    if (!option.choices.empty() && option.names.front()[0] != '-')
      roff += roffText("One of " + joined(option.choices, ", ") + ".");
    if (option.is_required && option.names.front()[0] == '-') roff += "Required.\n";
    if (!option.default_value.empty()) roff += "Default: " + roffLine(roffEscaped(option.default_value) + ".");
  }
  return roff + ".El\n";
}

std::string synopsis(const ProgramTree& tree, const CommandEntry& command) {
  std::string roff = ".Nm " + tree.program.name + "\n.Cm " + command.name + "\n.Op Ar options\n";
  for (const OptionGroup& group : command.groups)
    for (const OptionEntry& option : group.options)
      if (option.is_required) {
        OptionEntry shortest = option;
        shortest.names.resize(1);
        roff += "." + optionMacros(shortest) + "\n";
      }
  for (const OptionEntry& option : command.positionals)
    roff += std::string(option.is_required ? ".Ar " : ".Op Ar ") + option.names.front() +
            (option.is_unlimited ? " ..." : "") + "\n";
  return roff;
}

std::string optionSections(const CommandEntry& command) {
  std::string roff;
  if (!command.positionals.empty()) roff += ".Sh ARGUMENTS\n" + optionList(command.positionals);
  roff += ".Sh OPTIONS\n";
  for (const OptionGroup& group : command.groups)
    roff += (group.is_common ? "" : ".Ss " + group.title + "\n") + optionList(group.options);
  return roff;
}

std::string head(const std::string& page, const std::string& summary, const std::string& version,
                 const std::string& date) {
  std::string title = page;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return std::toupper(c); });
  return ".Dd " + date + "\n.Dt " + title + " 1\n.Os " + version + "\n.Sh NAME\n.Nm " + page + "\n.Nd " +
         roffEscaped(summary) + "\n";
}

const char* const kExitStatus =
    ".Sh EXIT STATUS\n.Bl -tag -width Ds -compact\n.It 0\nSuccess.\n.It 1\nAn error in the data, or of the system.\n"
    ".It 2\nWrong usage.\n.El\n";

}  // namespace

std::string programManPage(const ProgramTree& tree, const std::string& version, const std::string& date) {
  const std::string& name = tree.program.name;
  std::string roff = head(name, tree.program.summary, version, date) +
                     ".Sh SYNOPSIS\n.Nm\n.Op Ar options\n.Ar command\n.Op Ar ...\n" +
                     ".Sh DESCRIPTION\nEvery command has a page of its own.\nWith\n.Fl -help\na command prints its "
                     "common options, with\n.Fl -help-all\nall of them.\n.Sh COMMANDS\n.Bl -tag -width Ds\n";
  std::vector<std::string> pages;
  for (const CommandEntry& command : tree.commands) {
    roff += ".It Cm " + command.name + "\n" + roffText(withFullStop(command.summary));
    pages.push_back(name + "-" + command.name);
  }
  roff += ".El\n" + optionSections(tree.program) + kExitStatus + ".Sh EXAMPLES\n" + roffVerbatim(tree.program.example) +
          ".Sh SEE ALSO\n";
  std::sort(pages.begin(), pages.end());
  for (const std::string& page : pages) roff += ".Xr " + page + " 1" + (page == pages.back() ? "\n" : " ,\n");
  return roff;
}

std::string commandManPage(const ProgramTree& tree, const CommandEntry& command, const std::string& version,
                           const std::string& date) {
  return head(tree.program.name + "-" + command.name, command.summary, version, date) + ".Sh SYNOPSIS\n" +
         synopsis(tree, command) + ".Sh DESCRIPTION\n" + roffText(withFullStop(command.summary)) +
         roffDetails(command.details) + optionSections(command) + kExitStatus + ".Sh EXAMPLES\n" +
         roffVerbatim(command.example) + ".Sh SEE ALSO\n.Xr " + tree.program.name + " 1\n";
}

}  // namespace gaussmap::app
