// SPDX-License-Identifier: BSD-3-Clause
#include "reference/completions.h"
#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

const char* const kFishFunctions = R"(
# True if the command on the line is $argv[1]; without $argv[1], true if the line has no command yet.
function __gaussmap_command_is
    for word in (commandline -opc)[2..-1]
        if not string match -q -- '-*' $word
            test "$word" = "$argv[1]"
            return
        end
    end
    not set -q argv[1]
end

# Offers directories and the files with these endings; all files if nothing matches.
function __gaussmap_files
    set -l files (complete -C "'' "(commandline -ct))
    set -l endings (string escape --style=regex -- $argv | string join '|')
    string match -r -- ".*(?:/|$endings)\$" $files
    or string join \n -- $files
end

complete -c gaussmap -f
)";

std::string fishQuoted(const std::string& text) {
  return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
}

/// Returns what is offered for a value, such as " -x -a 'sensor map'".
std::string fishValue(const OptionEntry& option, bool is_positional) {
  std::string begin = is_positional ? "" : " -x";
  if (!option.choices.empty()) return begin + " -a '" + joined(option.choices, " ") + "'";
  if (option.kind == ValueKind::Folder) return begin + " -a '(__fish_complete_directories)'";
  if (option.kind == ValueKind::File && option.endings.empty()) return is_positional ? " -F" : " -r -F";
  if (option.kind == ValueKind::File) return begin + " -k -a '(__gaussmap_files " + joined(option.endings, " ") + ")'";
  return begin;
}

std::string fishOptions(const CommandEntry& command, const std::string& condition) {
  const std::string begin = "complete -c gaussmap -n " + condition;
  std::string text;
  for (const OptionGroup& group : command.groups)
    for (const OptionEntry& option : group.options) {
      text += begin;
      for (const std::string& name : option.names)
        text += name.compare(0, 2, "--") == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.kind != ValueKind::None) text += fishValue(option, false);
      text += " -d " + fishQuoted(option.description) + "\n";
    }
  for (const OptionEntry& option : command.positionals) text += begin + fishValue(option, true) + "\n";
  return text;
}

}  // namespace

std::string fishCompletion(const ProgramTree& tree) {
  std::string text = "# fish completion of gaussmap, written by: gaussmap completion fish\n" +
                     std::string(kFishFunctions) + fishOptions(tree.program, "__gaussmap_command_is");
  for (const CommandEntry& command : tree.commands)
    text += "complete -c gaussmap -n __gaussmap_command_is -a " + command.name + " -d " + fishQuoted(command.summary) +
            "\n";
  for (const CommandEntry& command : tree.commands)
    text += "\n" + fishOptions(command, "'__gaussmap_command_is " + command.name + "'");
  return text;
}

}  // namespace gaussmap::app
