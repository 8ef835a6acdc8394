// SPDX-License-Identifier: BSD-3-Clause
// gaussmap completion SHELL: the completion script of a shell. gaussmap reference: the documentation of the program as
// files, for the build and the docs folder.
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands/commands.h"
#include "common/command.h"
#include "gaussmap/version.h"
#include "io/files/atomic_file.h"
#include "reference/completions.h"
#include "reference/man_pages.h"
#include "reference/markdown.h"

namespace gaussmap::app {
namespace {

namespace fs = std::filesystem;

const Help kCompletionHelp = {
    "Print the completion script of a shell",
    "gaussmap completion bash > ~/.local/share/bash-completion/completions/gaussmap",
    R"(cmake --install puts the scripts where the shells look for them. Without it, save the script as
bash  ~/.local/share/bash-completion/completions/gaussmap
zsh   _gaussmap, in a directory of $fpath
fish  ~/.config/fish/completions/gaussmap.fish)"};

const Help kReferenceHelp = {
    "Write man pages, completion scripts and the command reference",
    "gaussmap reference --man man --completions completions --markdown commands.md",
    R"(The date of the man pages is today, or that of the environment variable SOURCE_DATE_EPOCH.)"};

struct ReferenceCommand {
  std::string man, completions, markdown;
  bool force = false;
};

struct TextFile {
  fs::path path;
  std::string text;
};

/// Returns the date in the form of mdoc(7), such as "May 4, 2026".
std::string dateOfPages() {
  const char* const given = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t time =
      given != nullptr ? static_cast<std::time_t>(std::strtoll(given, nullptr, 10)) : std::time(nullptr);
  std::tm date{};
  gmtime_r(&time, &date);
  const char* const months[] = {"January", "February", "March",     "April",   "May",      "June",
                                "July",    "August",   "September", "October", "November", "December"};
  return std::string(months[date.tm_mon]) + " " + std::to_string(date.tm_mday) + ", " +
         std::to_string(1900 + date.tm_year);
}

std::vector<TextFile> filesOf(const ReferenceCommand& command, const ProgramTree& tree) {
  const std::string& name = tree.program.name;
  std::vector<TextFile> files;
  if (!command.man.empty()) {
    const std::string version = name + " " GAUSSMAP_VERSION, date = dateOfPages();
    files.push_back({fs::path(command.man) / (name + ".1"), programManPage(tree, version, date)});
    for (const CommandEntry& one : tree.commands)
      files.push_back(
          {fs::path(command.man) / (name + "-" + one.name + ".1"), commandManPage(tree, one, version, date)});
  }
  if (!command.completions.empty()) {  // the shells look for these names
    files.push_back({fs::path(command.completions) / name, bashCompletion(tree)});
    files.push_back({fs::path(command.completions) / ("_" + name), zshCompletion(tree)});
    files.push_back({fs::path(command.completions) / (name + ".fish"), fishCompletion(tree)});
  }
  if (!command.markdown.empty()) files.push_back({command.markdown, markdownReference(tree)});
  return files;
}

/// Writes all files under temporary names, then renames them. If one cannot be written, none appears.
void writeAll(const std::vector<TextFile>& files) {
  std::vector<std::unique_ptr<detail::AtomicFile>> written;
  for (const TextFile& file : files) {
    written.push_back(std::make_unique<detail::AtomicFile>(file.path));
    written.back()->write(file.text.data(), file.text.size());
  }
  for (const auto& file : written) file->commit();
}

void writeReference(const ReferenceCommand& command, CLI::App& app) {
  const std::vector<TextFile> files = filesOf(command, programTree(app));
  if (files.empty()) throw UsageError("reference needs one of --man, --completions and --markdown");
  for (const std::string& folder : {command.man, command.completions})
    if (!folder.empty()) makeFolder(folder);
  std::vector<std::string> paths;
  paths.reserve(files.size());
  for (const TextFile& file : files) paths.push_back(file.path.string());
  checkOutputs(paths, command.force, {});
  writeAll(files);
}

void printCompletion(const std::string& shell, CLI::App& app) {
  const ProgramTree tree = programTree(app);
  std::cout << (shell == "bash" ? bashCompletion(tree) : shell == "zsh" ? zshCompletion(tree) : fishCompletion(tree));
}

}  // namespace

void addCompletion(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  Command command(app, "completion", kCompletionHelp);
  command.choice("shell", *shell, {"bash", "fish", "zsh"}, "the shell").required();
  command.onRun([shell, &app] { printCompletion(*shell, app); });
}

void addReference(CLI::App& app) {
  auto options = std::make_shared<ReferenceCommand>();
  Command command(app, "reference", kReferenceHelp);
  command.hide();
  command.text("--man", options->man, "directory to write the man pages to");
  command.text("--completions", options->completions, "directory to write the completion scripts to");
  command.text("--markdown", options->markdown, "file to write the command reference to (.md)");
  command.force(options->force, "replace existing files");
  command.folders({"--man", "--completions"});
  command.files({"--markdown"}, {".md"});
  command.onRun([options, &app] { writeReference(*options, app); });
}

}  // namespace gaussmap::app
