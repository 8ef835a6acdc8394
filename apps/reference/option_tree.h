// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

// The commands and options of the program as plain values. The command reference, the man pages and the completions of
// the shells are written from them.
namespace gaussmap::app {

enum class ValueKind { None, Word, File, Folder };  ///< None: a flag

struct OptionEntry {
  std::vector<std::string> names;  ///< "-o", "--output"; a positional argument has one name without dashes
  std::string description;
  ValueKind kind = ValueKind::None;
  std::string value;                 ///< what the help calls the value: "FLOAT"
  std::vector<std::string> choices;  ///< of which the value is one; empty: any value
  std::vector<std::string> endings;  ///< of files: ".gmap"; empty: any
  std::string default_value;         ///< empty: none, or the description says it
  int least_values = 0, most_values = 0;
  bool is_unlimited = false;  ///< any number of values from `least_values`
  bool is_repeatable = false;
  bool is_required = false;
};

struct OptionGroup {
  std::string title;
  bool is_common = false;  ///< shown by --help, the other groups by --help-all only
  std::vector<OptionEntry> options;
};

struct CommandEntry {
  std::string name;  ///< "pcd2map"
  std::string summary, details, example;
  std::vector<OptionEntry> positionals;
  std::vector<OptionGroup> groups;
};

struct ProgramTree {
  CommandEntry program;                ///< its own options
  std::vector<CommandEntry> commands;  ///< in the order of the help, without hidden ones
};

/// The tree of the program; the options of `view` are those of gaussmap-view.
ProgramTree programTree(CLI::App& program);

/// "FLOAT", "{sensor,map}", "FLOAT x 7", "TEXT ...", "[TEXT]"; empty for a flag.
std::string valueText(const OptionEntry& option);
/// "-o,--output FILE".
std::string optionText(const OptionEntry& option);
/// What follows the name of the command: "[OPTIONS] -o FILE map [cloud...]".
std::string usageText(const CommandEntry& command);

}  // namespace gaussmap::app
