// SPDX-License-Identifier: BSD-3-Clause
#include "common/help_formatter.h"

#include <algorithm>
#include <sstream>

namespace gaussmap::app {
namespace {

constexpr std::size_t kColumn = 32;  // first column of the descriptions
constexpr std::size_t kLineWidth = 110;

/// Breaks the text at white space into lines of at most `width` characters. A longer word gets its own line.
std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines, word;
  std::size_t used = 0;
  while (words >> word) {
    if (used > 0 && used + 1 + word.size() > width) {
      lines += '\n';
      used = 0;
    }
    lines += (used > 0 ? " " : "") + word;
    used += word.size() + (used > 0 ? 1 : 0);
  }
  return lines;
}

/// Returns "FLOAT", or the list of possible values: "{sensor,map}".
std::string typeOf(const CLI::Option& option) {
  const std::vector<std::string> choices = choicesOf(option);
  return choices.empty() ? valueNameOf(option) : "{" + CLI::detail::join(choices, ",") + "}";
}

class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(Help help) : help_(std::move(help)) { column_width(kColumn); }

  const Help& help() const { return help_; }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    const bool is_part = mode == CLI::AppFormatMode::Sub;  // one command within `gaussmap --help-all`
    if (is_part) name = "gaussmap " + app->get_name();
    std::string text = make_description(app) + make_usage(app, name) + make_positionals(app) + optionGroups(app, mode);
    if (mode != CLI::AppFormatMode::Normal && !help_.details.empty()) text += "\n" + help_.details + "\n";
    return text + "\nExample: " + help_.example + "\n";
  }

  std::string optionGroups(const CLI::App* app, CLI::AppFormatMode mode) const {
    std::string text;
    for (const std::string& group : app->get_groups()) {
      if (mode == CLI::AppFormatMode::Normal && group != kCommonGroup) continue;
      const std::vector<const CLI::Option*> options = app->get_options([&](const CLI::Option* option) {
        const bool is_help = option == app->get_help_ptr() || option == app->get_help_all_ptr();
        return option->get_group() == group && option->nonpositional() && !(is_help && mode == CLI::AppFormatMode::Sub);
      });
      if (!group.empty() && !options.empty()) text += make_group(group, false, options);
    }
    return text;
  }

  /// "4", or "4..6" if the number of values can vary.
  static std::string countText(const CLI::Option& option) {
    std::string least = std::to_string(option.get_expected_min());
    if (option.get_expected_max() == option.get_expected_min()) return least;
    return least + ".." + std::to_string(option.get_expected_max());
  }

  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    const std::string name = CLI::Formatter::make_option_name(option, is_positional);
    return name.substr(0, name.find('{'));  // the names of flags that set false end in "{false}"
  }

  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return "";
    std::string text = " " + typeOf(*option);
    if (!option->get_default_str().empty()) text += "=" + option->get_default_str();
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size)
      text += " ...";
    else if (option->get_expected_min() > 1)
      text += " x " + countText(*option);
    return option->get_required() && option->nonpositional() ? text + " (required)" : text;
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), kLineWidth - kColumn);
  }

 private:
  Help help_;
};

}  // namespace

std::shared_ptr<CLI::Formatter> makeHelpFormatter(const Help& help) {
  return std::make_shared<HelpFormatter>(help);
}

Help helpOf(const CLI::App& app) {
  const auto* const formatter = dynamic_cast<const HelpFormatter*>(app.get_formatter().get());
  return formatter != nullptr ? formatter->help() : Help{app.get_description(), "", ""};
}

std::string valueNameOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::vector<std::string> choicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  std::vector<std::string> choices = CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
  for (std::string& choice : choices) choice.resize(std::min(choice.size(), choice.find("->")));  // of named values
  return choices;
}

}  // namespace gaussmap::app
