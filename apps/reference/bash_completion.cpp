// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "reference/completions.h"
#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

const char* const kBashFunctions = R"(
# Offers the words of $1.
_gaussmap_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# Offers directories and the files with these endings; all files if no endings are given or nothing matches.
_gaussmap_files() {
  local ending
  compopt -o filenames 2>/dev/null
  if (($#)); then
    mapfile -t COMPREPLY < <(compgen -d -- "$cur"; for ending; do compgen -f -X "!*$ending" -- "$cur"; done)
  fi
  ((${#COMPREPLY[@]})) || mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}

_gaussmap_folders() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$cur")
}

)";

const char* const kBashStart = R"(_gaussmap() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command= i
  COMPREPLY=()
  # Bash splits --option=value into three words.
  if [[ $cur == = ]]; then
    cur=
  elif [[ $prev == = ]] && ((COMP_CWORD > 2)); then
    prev=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    if [[ ${COMP_WORDS[i]} != -* ]]; then
      command=${COMP_WORDS[i]}
      break
    fi
  done
)";

/// Returns the command of the script that offers the values of an option.
std::string bashValues(const OptionEntry& option) {
  if (!option.choices.empty()) return "_gaussmap_words \"" + joined(option.choices, " ") + "\"";
  if (option.kind == ValueKind::Folder) return "_gaussmap_folders";
  if (option.kind == ValueKind::File)
    return "_gaussmap_files" + std::string(option.endings.empty() ? "" : " ") + joined(option.endings, " ");
  return "";
}

/// Returns the command that offers the arguments of a command. It offers the same for every argument: all their words,
/// or files with the endings of any of them.
std::string bashPositionals(const CommandEntry& command) {
  OptionEntry any;
  for (const OptionEntry& option : command.positionals) {
    if (option.kind == ValueKind::File && any.kind == ValueKind::File &&
        (any.endings.empty() || option.endings.empty()))
      any.endings.clear();
    else
      any.endings.insert(any.endings.end(), option.endings.begin(), option.endings.end());
    if (any.kind != ValueKind::File) any.kind = option.kind;
    any.choices.insert(any.choices.end(), option.choices.begin(), option.choices.end());
  }
  return bashValues(any);
}

std::string bashCase(const CommandEntry& command) {
  std::map<std::string, std::string> names_of;  // options by the command that offers their values
  std::string options;
  for (const OptionGroup& group : command.groups)
    for (const OptionEntry& option : group.options) {
      options += (options.empty() ? "" : " ") + joined(option.names, " ");
      if (option.kind == ValueKind::None) continue;
      std::string& names = names_of[bashValues(option)];
      names += (names.empty() ? "" : " | ") + joined(option.names, " | ");
    }
  std::string text = "    " + command.name + ")\n      case $prev in\n";
  for (const auto& [values, names] : names_of)
    text += "        " + names + ") " + (values.empty() ? "" : values + "; ") + "return ;;\n";
  const std::string positionals = bashPositionals(command);
  text += "      esac\n      case $cur in\n        -*) _gaussmap_words \"" + options + "\" ;;\n";
  if (!positionals.empty()) text += "        *) " + positionals + " ;;\n";
  return text + "      esac\n      ;;\n";
}

}  // namespace

std::string bashCompletion(const ProgramTree& tree) {
  std::string words, options;
  for (const CommandEntry& command : tree.commands) words += (words.empty() ? "" : " ") + command.name;
  for (const OptionGroup& group : tree.program.groups)
    for (const OptionEntry& option : group.options) options += " " + joined(option.names, " ");
  std::string text = "# bash completion of gaussmap, written by: gaussmap completion bash\n" +
                     std::string(kBashFunctions) + kBashStart + "  case $command in\n    \"\") _gaussmap_words \"" +
                     words + options + "\" ;;\n";
  for (const CommandEntry& command : tree.commands) text += bashCase(command);
  return text + "  esac\n}\n\ncomplete -F _gaussmap gaussmap\n";
}

}  // namespace gaussmap::app
