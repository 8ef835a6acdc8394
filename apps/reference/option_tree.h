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
  std::string value;                 ///< name of the value in the help, such as "FLOAT"
  std::vector<std::string> choices;  ///< the possible values; empty: any value
  std::vector<std::string> endings;  ///< endings of the files, such as ".gmap"; empty: any
  std::string default_value;         ///< empty: none, or the description says it
  int min_values = 0, max_values = 0;
  bool is_unlimited = false;  ///< any number of values, at least `min_values`; the option can be repeated
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
  CommandEntry program;                ///< options of the program without a command
  std::vector<CommandEntry> commands;  ///< in the order of the help, without hidden ones
};

/// Returns the tree of the program. The options of `view` are those of gaussmap-view.
ProgramTree programTree(CLI::App& program);

/// Returns "FLOAT", "{sensor,map}", "FLOAT x 7", "TEXT ..." or "[TEXT]"; empty for a flag.
std::string valueText(const OptionEntry& option);
/// Returns the names and the value, such as "-o,--output FILE".
std::string optionText(const OptionEntry& option);
/// Returns the usage without the name of the command, such as "[OPTIONS] -o FILE map [cloud...]".
std::string usageText(const CommandEntry& command);

}  // namespace gaussmap::app
