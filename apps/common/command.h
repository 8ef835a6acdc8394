// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/usage.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

// Commands and their options. CLI11 takes seconds to compile, so only command.cpp, help_formatter.h and the main
// programs include it.
namespace gaussmap::app {

/// The help texts of a command.
struct Help {
  std::string summary;  ///< one line, also in the list of commands
  std::string example;  ///< one command line
  std::string details;  ///< paragraphs that only --help-all shows
};

/// An option of a command.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option required() const;
  Option rare() const;                          ///< shown only by --help-all
  Option group(const std::string& name) const;  ///< like rare(), under this heading
  Option needs(const Option& other) const;
  Option excludes(const Option& other) const;
  Option type(const std::string& name) const;  ///< the placeholder of its value in the help
  Option hideDefault() const;
  Option atLeast(int count) const;  ///< takes `count` values or more
  Option onePerUse() const;         ///< may be given several times, each time with one value
  Option valueMayBeMissing(const std::string& then) const;

 private:
  CLI::Option* option_;
};

/// A command of the program, to which options are added. Names without dashes are positional arguments. The variables
/// must live as long as the program. Their values at the call are the defaults, which the help shows.
class Command {
 public:
  Command(CLI::App& program, const std::string& name, const Help& help);
  Command(CLI::App& program, const Help& help);  ///< a program without commands

  Option flag(const std::string& name, bool& value, const std::string& help);
  /// A flag that sets other defaults: `apply` writes them into the variables of the options. An option overrides them
  /// if it is given and was added after this one. So add the flag before them, and after the options that `apply`
  /// reads.
  Option preset(const std::string& name, const std::function<void()>& apply, const std::string& help);
  Option text(const std::string& name, std::string& value, const std::string& help);
  Option texts(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// T: int, std::size_t, double, or std::optional of one of them. Floating-point ranges refuse NaN.
  template <typename T>
  Option number(const std::string& name, T& value, const std::string& help);
  template <typename T>
  Option number(const std::string& name, T& value, double low, double high, const std::string& help);
  /// `least` to `most` numbers; below: exactly `count` numbers.
  Option numbers(const std::string& name, std::vector<double>& values, int least, int most, double low, double high,
                 const std::string& help);
  Option numbers(const std::string& name, std::vector<double>& values, int count, double low, double high,
                 const std::string& help) {
    return numbers(name, values, count, count, low, high, help);
  }
  /// Numbers separated by commas.
  Option list(const std::string& name, std::vector<double>& values, double low, double high, const std::string& help);

  /// One of these words. T: std::string, or std::optional of it.
  template <typename T>
  Option choice(const std::string& name, T& value, const std::vector<std::string>& words, const std::string& help);
  /// One of these named values.
  template <typename T>
  Option choiceOf(const std::string& name, T& value, const std::map<std::string, T>& named, const std::string& help) {
    std::string now;
    for (const auto& [word, one] : named)
      if (one == value) now = word;
    const auto set = [&value, named](const std::string& word) { value = named.at(word); };
    return choice(name, wordsOf(named), now, set, help);
  }
  template <typename T>
  static std::vector<std::string> wordsOf(const std::map<std::string, T>& named) {
    std::vector<std::string> words;
    words.reserve(named.size());
    for (const auto& entry : named) words.push_back(entry.first);
    return words;
  }

  // Options that several commands share.
  void map(std::string& path);                           ///< MAP
  void output(Output& output, const std::string& help);  ///< -o (required) and --force
  Option force(bool& value, const std::string& help = "replace an existing output");
  Option seed(std::uint64_t& value, const std::string& help);
  Option threads(int& value);
  void json(bool& value);
  /// --scale. T: int or std::optional<int>.
  template <typename T>
  Option scale(T& value, const std::string& help) {
    return number("--scale", value, 0, 63, help);
  }

  /// At most one of these options may be given.
  void exclusive(const std::vector<std::string>& names);
  /// The option cannot be combined with any of the others.
  void excludes(const std::string& name, const std::vector<std::string>& others);
  /// The values of these options are names of files or directories. `endings`, such as ".gmap", are those that the
  /// completion of the shell offers; empty: all files.
  void files(const std::vector<std::string>& names, const std::vector<std::string>& endings = {});
  /// The values of these options are names of directories.
  void folders(const std::vector<std::string>& names);
  bool isGiven(const std::string& name) const;
  /// The name of an option of this group that was given; empty if none was given.
  std::string givenOf(const std::string& group) const;

  /// Leaves the command out of the list of commands.
  void hide();
  /// Sets the function that runs the command after its options have been read.
  void onRun(const std::function<void()>& run);
  /// Passes all words after the name of the command, including --help, to `run` unparsed.
  void passOn(const std::function<void(const std::vector<std::string>&)>& run);

 private:
  Option choice(const std::string& name, const std::vector<std::string>& words, const std::string& now,
                const std::function<void(const std::string&)>& set, const std::string& help);
  CLI::App* app_;
};

}  // namespace gaussmap::app
