// SPDX-License-Identifier: BSD-3-Clause
#include "reference/option_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "commands/view_options.h"
#include "common/help_formatter.h"
#include "reference/help_text.h"

namespace gaussmap::app {
namespace {

/// Returns the endings that Command::files() has stored in the option.
std::vector<std::string> endingsOf(CLI::Option& option) {
  const std::string endings = option.get_validator(0)->get_name();
  return endings.empty() ? std::vector<std::string>() : CLI::detail::split(endings, ' ');
}

OptionEntry entryOf(CLI::Option& option) {
  OptionEntry entry;
  if (option.get_positional()) entry.names.push_back(option.get_name(true));
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  entry.description = option.get_description();
  entry.is_required = option.get_required();
  if (option.get_items_expected_max() == 0) return entry;  // a flag
  entry.value = valueNameOf(option);
  entry.kind = entry.value == "FILE" ? ValueKind::File : entry.value == "DIR" ? ValueKind::Folder : ValueKind::Word;
  entry.choices = choicesOf(option);
  if (entry.kind == ValueKind::File) entry.endings = endingsOf(option);
  entry.default_value = option.get_default_str();
  entry.min_values = option.get_expected_min();
  entry.max_values = option.get_expected_max();
  entry.is_unlimited = entry.max_values >= CLI::detail::expected_max_vector_size;
  return entry;
}

CommandEntry commandOf(CLI::App& app) {
  const Help help = helpOf(app);
  CommandEntry command;
  command.name = app.get_name();
  command.summary = help.summary;
  command.details = help.details;
  command.example = help.example;
  for (CLI::Option* option : app.get_options({}))
    if (option->get_positional()) command.positionals.push_back(entryOf(*option));
  for (const std::string& title : app.get_groups()) {
    if (title.empty()) continue;  // hidden
    OptionGroup group = {title, title == kCommonGroup, {}};
    for (CLI::Option* option : app.get_options({}))
      if (option->get_group() == title && option->nonpositional()) group.options.push_back(entryOf(*option));
    if (!group.options.empty()) command.groups.push_back(std::move(group));
  }
  return command;
}

CommandEntry viewEntry() {
  CLI::App app("", "view");
  app.set_help_all_flag("--help-all", kViewHelpAll);
  ViewCommand options;
  addViewOptions(app, options);
  return commandOf(app);
}

}  // namespace

ProgramTree programTree(CLI::App& program) {
  ProgramTree tree;
  tree.program = commandOf(program);
  const std::string footer = program.get_footer(), example = "Example: ";
  tree.program.example = footer.substr(footer.compare(0, example.size(), example) == 0 ? example.size() : 0);
  for (CLI::App* command : program.get_subcommands([](CLI::App* app) { return !app->get_group().empty(); }))
    tree.commands.push_back(command->get_name() == "view" ? viewEntry() : commandOf(*command));
  return tree;
}

std::string valueText(const OptionEntry& option) {
  if (option.kind == ValueKind::None) return "";
  std::string value = option.choices.empty() ? option.value : "{" + joined(option.choices, ",") + "}";
  if (option.is_unlimited) return value + " ...";
  if (option.min_values == 0) return "[" + value + "]";
  if (option.max_values == 1) return value;
  const auto words = 1 + std::count(value.begin(), value.end(), ' ');
  if (option.min_values == option.max_values && words == option.min_values) return value;  // "X Y Z"
  const std::string min = std::to_string(option.min_values), max = std::to_string(option.max_values);
  if (option.min_values == option.max_values) return value + " x " + min;
  return option.max_values >= 1000 ? value + " ..." : value + " x " + min + " to " + max;
}

std::string optionText(const OptionEntry& option) {
  const std::string names = joined(option.names, ","), value = valueText(option);
  return value.empty() ? names : names + " " + value;
}

std::string usageText(const CommandEntry& command) {
  std::string text = "[OPTIONS]";
  for (const OptionGroup& group : command.groups)
    for (const OptionEntry& option : group.options)
      if (option.is_required) text += " " + option.names.front() + " " + valueText(option);
  for (const OptionEntry& option : command.positionals) {
    const std::string name = option.names.front() + (option.is_unlimited ? "..." : "");
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return text;
}

}  // namespace gaussmap::app
