// SPDX-License-Identifier: BSD-3-Clause
#include "common/command.h"

#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <thread>
#include <type_traits>

#include "common/help_formatter.h"

namespace gaussmap::app {
namespace {

template <typename Number>
bool isNumber(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

/// Accepts a number from `low` to `high`. Unlike CLI::Range, it refuses NaN.
CLI::Validator numberBetween(double low, double high) {
  std::ostringstream range;
  range << low << " to " << high;
  return CLI::Validator(
      [low, high, possible = range.str()](std::string& text) -> std::string {
        double value = 0.0;
        if (!isNumber(text, value)) return "'" + text + "' is not a number";
        return value >= low && value <= high ? "" : text + " is not in the range " + possible;
      },
      range.str());
}

/// Number of processors that this process may use.
int processors() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0
             ? CPU_COUNT(&set)
             : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Limits the threads to the number of processors, because TBB warns on stderr if there are more.
std::string limitThreads(std::string& text) {
  int threads = 0;
  if (isNumber(text, threads) && threads <= 1024) text = std::to_string(std::min(threads, processors()));
  return "";
}

std::string checkSeed(std::string& text) {
  std::uint64_t value = 0;
  return isNumber(text, value) ? "" : "'" + text + "' is not a whole number from 0 to 2^64 - 1";
}

template <typename T>
struct NumberOf {
  using Type = T;
  static constexpr bool kOptional = false;
};
template <typename T>
struct NumberOf<std::optional<T>> {
  using Type = T;
  static constexpr bool kOptional = true;
};

template <typename T>
CLI::Option* withDefault(CLI::Option* option) {
  return NumberOf<T>::kOptional ? option : option->capture_default_str();
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}
Option Option::rare() const {
  return group("More options");
}
Option Option::group(const std::string& name) const {
  option_->group(name);
  return *this;
}
Option Option::needs(const Option& other) const {
  option_->needs(other.option_);
  return *this;
}
Option Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}
Option Option::type(const std::string& name) const {
  option_->type_name(name);
  return *this;
}
Option Option::hideDefault() const {
  option_->default_str("");
  return *this;
}
Option Option::atLeast(int count) const {
  option_->expected(count, -1);
  return *this;
}
Option Option::onePerUse() const {
  option_->allow_extra_args(false);
  return *this;
}
Option Option::valueMayBeMissing(const std::string& then) const {
  option_->expected(0, 1)->default_str(then);
  return *this;
}

Command::Command(CLI::App& program, const std::string& name, const Help& help)
    : app_(program.add_subcommand(name, help.summary)) {
  app_->formatter(makeHelpFormatter(help));
}

Command::Command(CLI::App& program, const Help& help) : app_(&program) {
  app_->description(help.summary);
  app_->formatter(makeHelpFormatter(help));
}

Option Command::flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

Option Command::preset(const std::string& name, const std::function<void()>& apply, const std::string& help) {
  return Option(app_->add_flag_callback(name, apply, help));  // CLI11 sets the options in the order they were added
}

Option Command::text(const std::string& name, std::string& value, const std::string& help) {
  return Option(app_->add_option(name, value, help)->capture_default_str());
}

Option Command::texts(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  return Option(app_->add_option(name, values, help));
}

template <typename T>
Option Command::number(const std::string& name, T& value, const std::string& help) {
  return Option(withDefault<T>(app_->add_option(name, value, help)));
}

template <typename T>
Option Command::number(const std::string& name, T& value, double low, double high, const std::string& help) {
  using Number = typename NumberOf<T>::Type;
  CLI::Option* const option = app_->add_option(name, value, help);
  if constexpr (std::is_floating_point_v<Number>)
    option->check(numberBetween(low, high));
  else
    option->check(CLI::Range(static_cast<Number>(low), static_cast<Number>(high)));
  return Option(withDefault<T>(option));
}

template Option Command::number(const std::string&, int&, const std::string&);
template Option Command::number(const std::string&, std::size_t&, const std::string&);
template Option Command::number(const std::string&, double&, const std::string&);
template Option Command::number(const std::string&, std::optional<int>&, const std::string&);
template Option Command::number(const std::string&, std::optional<std::size_t>&, const std::string&);
template Option Command::number(const std::string&, std::optional<double>&, const std::string&);
template Option Command::number(const std::string&, int&, double, double, const std::string&);
template Option Command::number(const std::string&, std::size_t&, double, double, const std::string&);
template Option Command::number(const std::string&, double&, double, double, const std::string&);
template Option Command::number(const std::string&, std::optional<int>&, double, double, const std::string&);
template Option Command::number(const std::string&, std::optional<std::size_t>&, double, double, const std::string&);
template Option Command::number(const std::string&, std::optional<double>&, double, double, const std::string&);

Option Command::numbers(const std::string& name, std::vector<double>& values, int least, int most, double low,
                        double high, const std::string& help) {
  return Option(app_->add_option(name, values, help)->expected(least, most)->check(numberBetween(low, high)));
}

Option Command::list(const std::string& name, std::vector<double>& values, double low, double high,
                     const std::string& help) {
  return Option(app_->add_option(name, values, help)->delimiter(',')->check(numberBetween(low, high)));
}

template <typename T>
Option Command::choice(const std::string& name, T& value, const std::vector<std::string>& words,
                       const std::string& help) {
  return Option(withDefault<T>(app_->add_option(name, value, help)->check(CLI::IsMember(words))));
}
template Option Command::choice(const std::string&, std::string&, const std::vector<std::string>&, const std::string&);
template Option Command::choice(const std::string&, std::optional<std::string>&, const std::vector<std::string>&,
                                const std::string&);

Option Command::choice(const std::string& name, const std::vector<std::string>& words, const std::string& now,
                       const std::function<void(const std::string&)>& set, const std::string& help) {
  return Option(app_->add_option_function<std::string>(name, set, help)
                    ->transform(CLI::IsMember(words, CLI::ignore_case))
                    ->default_str(now));
}

void Command::map(std::string& path) {
  text("map", path, "map (.gmap, or PCD of Gaussians)").required();
  files({"map"}, {".gmap", ".pcd"});
}

void Command::output(Output& output, const std::string& help) {
  text("-o,--output", output.path, help).required();
  force(output.force);
}

Option Command::force(bool& value, const std::string& help) {
  return flag("--force", value, help);
}

Option Command::seed(std::uint64_t& value, const std::string& help) {
  return Option(app_->add_option("--seed", value, help)->check(CLI::Validator(checkSeed, ""))->capture_default_str());
}

Option Command::threads(int& value) {
  return Option(app_->add_option("--threads", value, "number of threads, 0 = all cores")
                    ->check(CLI::Range(0, 1024))
                    ->transform(CLI::Validator(limitThreads, ""))
                    ->capture_default_str());
}

void Command::json(bool& value) {
  flag("--json", value, "print the result as JSON");
}

void Command::exclusive(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    for (const std::string& other : names)
      if (name != other) app_->get_option(name)->excludes(app_->get_option(other));
}

void Command::excludes(const std::string& name, const std::vector<std::string>& others) {
  for (const std::string& other : others) app_->get_option(name)->excludes(app_->get_option(other));
}

void Command::files(const std::vector<std::string>& names, const std::vector<std::string>& endings) {
  // A check that accepts everything and whose name option_tree.cpp reads. As a type, errors would quote it.
  const CLI::Validator note([](std::string&) { return std::string(); }, "", CLI::detail::join(endings, " "));
  for (const std::string& name : names) app_->get_option(name)->type_name("FILE")->check(note);
}

void Command::folders(const std::vector<std::string>& names) {
  for (const std::string& name : names) app_->get_option(name)->type_name("DIR");
}

void Command::hide() {
  app_->group("");
}

bool Command::isGiven(const std::string& name) const {
  return app_->count(name) > 0;
}

std::string Command::givenOf(const std::string& group) const {
  const CLI::App& app = *app_;
  for (const CLI::Option* option :
       app.get_options([&](const CLI::Option* o) { return o->get_group() == group && o->count() > 0; }))
    return option->get_name();
  return "";
}

void Command::onRun(const std::function<void()>& run) {
  app_->callback(run);
}

void Command::passOn(const std::function<void(const std::vector<std::string>&)>& run) {
  app_->prefix_command();
  app_->set_help_flag();
  app_->set_help_all_flag();
  app_->callback([app = app_, run] { run(app->remaining()); });
}

}  // namespace gaussmap::app
