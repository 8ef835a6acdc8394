// SPDX-License-Identifier: BSD-3-Clause
#include "reference/completions.h"
#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

/// Escapes a text for a specification of _arguments between single quotes.
std::string zshEscaped(std::string text) {
  text = replaced(text, "\\", "\\\\");
  for (const char* const mark : {"[", "]", ":"}) text = replaced(text, mark, std::string("\\") + mark);
  return replaced(text, "'", "'\\''");
}

/// Returns the name of a value and its completion, such as :FILE:_files -g "*.gmap".
std::string zshValue(const OptionEntry& option, const std::string& name) {
  std::string action = " ";
  if (!option.choices.empty()) {
    action = "(" + joined(option.choices, " ") + ")";
  } else if (option.kind == ValueKind::Folder) {
    action = "_files -/";
  } else if (option.kind == ValueKind::File) {
    std::string endings = joined(option.endings, "|");
    if (option.endings.size() > 1) endings = "(" + endings + ")";  // "*(.pcd)" would be a qualifier
    action = endings.empty() ? "_files" : "_files -g \"*" + endings + "\"";
  }
  return ":" + zshEscaped(name) + ":" + action;
}

std::string zshOption(const OptionEntry& option) {
  std::string marked;  // names with the character before a value
  for (const std::string& name : option.names) {
    const bool is_long = name.compare(0, 2, "--") == 0;
    marked += (marked.empty() ? "" : ",") + name + (option.kind == ValueKind::None ? "" : is_long ? "=" : "+");
  }
  const bool is_one = option.names.size() == 1;
  std::string text = option.is_unlimited ? "'*'" : is_one ? "" : "'(" + joined(option.names, " ") + ")'";
  text += (is_one ? "'" + marked : "{" + marked + "}'") + "[" + zshEscaped(option.description) + "]";
  if (option.kind != ValueKind::None && option.min_values == 0) text += ":";  // the value may be missing
  if (option.kind != ValueKind::None) text += zshValue(option, option.value);
  for (int i = 1; i < option.min_values; ++i) text += zshValue(option, option.value);
  return text + "'";
}

std::string zshCommand(const CommandEntry& command) {
  std::string text = "    " + command.name + ")\n      _arguments";
  for (const OptionGroup& group : command.groups)
    for (const OptionEntry& option : group.options) text += " \\\n        " + zshOption(option);
  int place = 0;
  for (const OptionEntry& option : command.positionals) {
    ++place;
    const std::string at = option.is_unlimited ? "*" : std::to_string(place) + (option.is_required ? "" : ":");
    text += " \\\n        '" + at + zshValue(option, option.names.front()) + "'";
  }
  return text + "\n      ;;\n";
}

}  // namespace

std::string zshCompletion(const ProgramTree& tree) {
  std::string text =
      "#compdef gaussmap\n# zsh completion of gaussmap, written by: gaussmap completion zsh\n\n"
      "_gaussmap_commands() {\n  local -a commands\n  commands=(\n";
  for (const CommandEntry& command : tree.commands)
    text += "    '" + command.name + ":" + replaced(command.summary, "'", "'\\''") + "'\n";
  text +=
      "  )\n  _describe -t commands command commands\n}\n\n_gaussmap() {\n  local curcontext=$curcontext state line\n"
      "  typeset -A opt_args\n  _arguments -C -A '-*'";
  for (const OptionGroup& group : tree.program.groups)
    for (const OptionEntry& option : group.options) text += " \\\n    " + zshOption(option);
  text +=
      " \\\n    '1:command:_gaussmap_commands' \\\n    '*::argument:->argument' && return\n"
      "  [[ $state == argument ]] || return\n  curcontext=${curcontext%:*}-$words[1]:\n  case $words[1] in\n";
  for (const CommandEntry& command : tree.commands) text += zshCommand(command);
  return text +
         "  esac\n}\n\nif [[ $funcstack[1] == _gaussmap ]]; then\n  _gaussmap \"$@\"\nelse  # sourced\n"
         "  compdef _gaussmap gaussmap\nfi\n";
}

}  // namespace gaussmap::app
