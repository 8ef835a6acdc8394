// SPDX-License-Identifier: BSD-3-Clause
// What is written from the options of the program: man pages, docs/commands.md, completions of bash, zsh and fish.
#include <algorithm>
#include <sstream>

#include "apps/app_fixture.h"
#include "apps/shell.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Runs zsh on a pseudo terminal, types $3, Tab and Ctrl-X there, and prints the completed line. Ctrl-X writes it into
/// the named pipe $2, so nothing has to wait or poll.
const char* const kTypeInZsh = R"(zmodload zsh/zpty
zpty -b shell TERM=vt100 zsh -f -i
zpty -w shell "fpath=(${(q)1} \$fpath); autoload -Uz compinit; compinit -u -D
report() { print -r -- \"\$BUFFER\" > ${(q)2}; exit }; zle -N report; bindkey '^X' report"
zpty -w -n shell "$3"$'\t\x18'
cat $2
zpty -d shell
)";

std::string lineIn(const std::string& text, std::size_t at) {
  return text.substr(at, text.find('\n', at) - at);
}

/// The part of a text from a mark to the next line that begins with `end`.
std::string sectionOf(const std::string& text, const std::string& mark, const std::string& end) {
  const std::size_t begin = text.find(mark);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n" + end, begin + mark.size()) - begin);
}

class Reference : public AppTest {
 protected:
  static void SetUpTestSuite() {
    pages_ = std::make_unique<TemporaryDirectory>();
    succeed({"reference", "--man", written("man"), "--completions", written("completions"), "--markdown",
             written("commands.md")});
  }
  static void TearDownTestSuite() { pages_.reset(); }

  static std::string written(const std::string& name) { return (pages_->path() / name).string(); }
  static std::string script(const std::string& name) { return written("completions/" + name); }

  void SetUp() override {
    std::istringstream lines(sectionOf(succeed({"--help"}), "Subcommands:\n", "\n"));
    std::string line;
    for (std::getline(lines, line); std::getline(lines, line);)
      if (line.compare(0, 2, "  ") == 0 && line[2] != ' ') commands_.push_back(line.substr(2, line.find(' ', 2) - 2));
    ASSERT_GT(commands_.size(), 20u);
  }

  /// The options that --help-all of a command shows: "-o", "--output", ...
  static Words optionsOf(const std::string& command) {
    Words options;
    std::istringstream lines(succeed({command, "--help-all"}));
    for (std::string line; std::getline(lines, line);) {
      if (line.compare(0, 3, "  -") != 0 || line.compare(0, 4, "  - ") == 0) continue;
      std::istringstream names(line.substr(2, line.find(' ', 2) - 2));
      for (std::string name; std::getline(names, name, ',');) options.push_back(name);
    }
    return options;
  }
  /// The commands whose help can be asked for.
  Words commandsWithHelp() const {
    Words commands = commands_;
    if (GAUSSMAP_HAS_VIEWER == 0) commands.erase(std::find(commands.begin(), commands.end(), "view"));
    return commands;
  }

  /// What bash offers for the last word of the line, in the directory of the test.
  Words bashOffers(const Words& line) const {
    std::string words;
    for (const std::string& word : line) words += " " + shellQuoted(word);
    return linesOf(
        "cd " + own("") + " && bash --norc -c 'source \"$0\"; COMP_WORDS=(gaussmap \"$@\"); COMP_CWORD=$#; " +
        "_gaussmap; ((${#COMPREPLY[@]} == 0)) || printf \"%s\\n\" \"${COMPREPLY[@]}\"' " + script("gaussmap") + words);
  }
  /// What fish offers at the end of the line, without explanations.
  Words fishOffers(const std::string& line) const {
    Words offers =
        linesOf("cd " + own("") + " && XDG_CONFIG_HOME=" + own("") + "/.config fish --no-config -c 'source " +
                script("gaussmap.fish") + "; complete -C \"" + line + "\"'");
    for (std::string& offer : offers) offer = offer.substr(0, offer.find('\t'));
    return offers;
  }
  std::string zshCompletes(const std::string& line) {
    const std::string typist = directory_.write("type.zsh", kTypeInZsh), result = own("line");
    fs::remove(result);
    const Words lines = linesOf("cd " + own("") + " && mkfifo " + result + " && zsh -f " + typist + " " + script("") +
                                " " + result + " " + shellQuoted(line));
    return lines.empty() ? "" : lines.front();
  }
  void makeFiles() {
    for (const char* const name : {"map.gmap", "one scan.pcd", "notes.md"}) directory_.write(name, "");
    fs::create_directory(own("folder"));
  }
  static Words sorted(Words words) {
    std::sort(words.begin(), words.end());
    return words;
  }

  Words commands_;

 private:
  static inline std::unique_ptr<TemporaryDirectory> pages_;
};

TEST_F(Reference, IsThePageInDocs) {
  EXPECT_TRUE(contentsOf(written("commands.md")) == contentsOf(GAUSSMAP_DOCS "/commands.md"))
      << "run: gaussmap reference --markdown docs/commands.md --force";
}

TEST_F(Reference, HasEveryOptionOfTheHelp) {
  const std::string markdown = contentsOf(written("commands.md")), zsh = contentsOf(script("_gaussmap"));
  const bool has_fish = isInstalled("fish");
  for (const std::string& command : commandsWithHelp()) {
    SCOPED_TRACE(command);
    const std::string page = contentsOf(written("man/gaussmap-" + command + ".1")),
                      section = sectionOf(markdown, "\n## gaussmap " + command + "\n", "## "),
                      specifications = sectionOf(zsh, "\n    " + command + ")\n", "      ;;");
    const Words options = optionsOf(command), bash = bashOffers({command, "-"});
    ASSERT_GE(options.size(), 3u);
    EXPECT_EQ(sorted(bash), sorted(options));
    const Words fish = has_fish ? fishOffers("gaussmap " + command + " --") : Words();
    for (const std::string& option : options) {
      const bool is_long = option.compare(0, 2, "--") == 0;
      EXPECT_NE(page.find("Fl " + option.substr(1) + (is_long ? "" : " , Fl ")), std::string::npos) << option;
      EXPECT_NE(section.find((is_long ? "" : "`") + option), std::string::npos) << option;
      EXPECT_NE(specifications.find(option), std::string::npos) << option;
      const bool is_in_fish = !has_fish || !is_long || std::count(fish.begin(), fish.end(), option) == 1;
      EXPECT_TRUE(is_in_fish) << option;
    }
  }
}

TEST_F(Reference, HasEveryCommandAndNoHiddenOne) {
  const std::string page = contentsOf(written("man/gaussmap.1")), markdown = contentsOf(written("commands.md"));
  for (const std::string& command : commands_) {
    EXPECT_NE(page.find("It Cm " + command + "\n"), std::string::npos) << command;
    EXPECT_NE(markdown.find("(#gaussmap-" + command + ")"), std::string::npos) << command;
    EXPECT_TRUE(fs::exists(written("man/gaussmap-" + command + ".1"))) << command;
  }
  EXPECT_FALSE(fs::exists(written("man/gaussmap-reference.1")));
  const std::string message = runApp({"nonsense"}).err;
  EXPECT_NE(message.find("completion"), std::string::npos) << message;
  EXPECT_EQ(message.find("reference"), std::string::npos) << message;
}

TEST_F(Reference, SaysDefaultsAndUnits) {
  const std::string markdown = contentsOf(written("commands.md")), page = contentsOf(written("man/gaussmap-pcd2map.1"));
  const std::string row = lineIn(markdown, markdown.find("| `--resolution FLOAT`"));
  EXPECT_NE(row.find("[m]"), std::string::npos) << row;
  EXPECT_NE(row.find("`0.1`"), std::string::npos) << row;
  const std::string entry = sectionOf(page, "Fl -resolution", ".It");
  EXPECT_NE(entry.find("[m]"), std::string::npos) << entry;
  EXPECT_NE(entry.find("Default: 0.1"), std::string::npos) << entry;
}

TEST_F(Reference, ManPagesAreCorrect) {
  if (!isInstalled("mandoc")) GTEST_SKIP() << "mandoc is not installed";
  EXPECT_EQ(linesOf("mandoc -Tlint -W warning " + written("man") + "/*.1"), Words());
  const Words page = linesOf("mandoc -Tascii " + written("man/gaussmap-refine.1") + " | col -b");
  const auto isSynopsis = [](const std::string& line) {
    return line.find("[options] -o FILE map") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(page.begin(), page.end(), isSynopsis)) << testing::PrintToString(page);
}

TEST_F(Reference, ManPagesHaveTheDateThatIsAskedFor) {
  const Outcome outcome =
      runApp({"reference", "--man", own("man")}, "", [] { ::setenv("SOURCE_DATE_EPOCH", "86400", 1); });
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(lineIn(contentsOf(own("man/gaussmap.1")), 0), ".Dd January 2, 1970");
}

TEST_F(Reference, BashCompletes) {
  makeFiles();
  const Words first = bashOffers({""});
  for (const std::string& command : commands_) EXPECT_EQ(std::count(first.begin(), first.end(), command), 1) << command;
  EXPECT_EQ(bashOffers({"pcd"}), Words({"pcd2map"}));
  EXPECT_EQ(bashOffers({"--ver"}), Words({"--version"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--reso"}), Words({"--resolution"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--frame", ""}), Words({"sensor", "map"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--frame", "=", "s"}), Words({"sensor"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--frame", "="}), Words({"sensor", "map"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--resolution", ""}), Words());
  EXPECT_EQ(bashOffers({"pcd2map", "--json", ""}), Words({"folder", "one scan.pcd"}));
  EXPECT_EQ(bashOffers({"pcd2map", "-o", ""}), Words({"folder", "map.gmap"}));
  EXPECT_EQ(bashOffers({"pcd2map", "--poses", ""}).size(), 4u);
  EXPECT_EQ(bashOffers({"pcd2map", "note"}), Words({"notes.md"}));  // better than nothing
  EXPECT_EQ(bashOffers({"simulate", "-o", ""}), Words({"folder"}));
  EXPECT_EQ(bashOffers({"simulate", "str"}), Words({"street"}));
  EXPECT_EQ(bashOffers({"view", "map.gmap", "--up", "-"}), Words({"-x", "-y", "-z"}));
  EXPECT_EQ(bashOffers({"completion", ""}), Words({"bash", "fish", "zsh"}));
}

TEST_F(Reference, FishCompletes) {
  if (!isInstalled("fish")) GTEST_SKIP() << "fish is not installed";
  makeFiles();
  EXPECT_EQ(linesOf("fish -n " + script("gaussmap.fish")), Words());
  EXPECT_EQ(sorted(fishOffers("gaussmap ")), sorted(commands_));
  EXPECT_EQ(fishOffers("gaussmap pcd2map --reso"), Words({"--resolution"}));
  EXPECT_EQ(fishOffers("gaussmap pcd2map --frame "), Words({"map", "sensor"}));
  EXPECT_EQ(sorted(fishOffers("gaussmap pcd2map view -o ")), Words({"folder/", "map.gmap"}));
  EXPECT_EQ(sorted(fishOffers("gaussmap info ")), Words({"folder/", "map.gmap", "one scan.pcd"}));
  EXPECT_EQ(fishOffers("gaussmap info note"), Words({"notes.md"}));  // better than nothing
  EXPECT_EQ(fishOffers("gaussmap simulate str"), Words({"street"}));
}

TEST_F(Reference, ZshCompletes) {
  if (!isInstalled("zsh")) GTEST_SKIP() << "zsh is not installed";
  makeFiles();
  EXPECT_EQ(linesOf("zsh -n " + script("_gaussmap")), Words());
  EXPECT_EQ(zshCompletes("gaussmap pcd2m"), "gaussmap pcd2map ");
  EXPECT_EQ(zshCompletes("gaussmap pcd2map --reso"), "gaussmap pcd2map --resolution=");  // a blank replaces the =
  EXPECT_EQ(zshCompletes("gaussmap pcd2map --frame se"), "gaussmap pcd2map --frame sensor ");
  EXPECT_EQ(zshCompletes("gaussmap pcd2map -o m"), "gaussmap pcd2map -o map.gmap ");
}

TEST_F(Reference, PrintsTheScriptThatItWrites) {
  EXPECT_EQ(succeed({"completion", "bash"}), contentsOf(script("gaussmap")));
  EXPECT_EQ(succeed({"completion", "zsh"}), contentsOf(script("_gaussmap")));
  EXPECT_EQ(succeed({"completion", "fish"}), contentsOf(script("gaussmap.fish")));
  expectUsageError("tcsh", {"completion", "tcsh"});
  expectUsageError("shell", {"completion"});
}

TEST_F(Reference, IsWrittenWholeOrNotAtAll) {
  expectUsageError("--man", {"reference"});
  expectUsageError("missing", {"reference", "--markdown", own("missing/commands.md")});
  fs::create_directories(own("pages"));
  directory_.write("pages/gaussmap-view.1", "mine");
  expectUsageError("--force", {"reference", "--man", own("pages"), "--markdown", own("commands.md")});
  fs::remove(own("pages/gaussmap-view.1"));
  fs::create_directory(own("pages/gaussmap-view.1"));
  expectUsageError("directory", {"reference", "--man", own("pages"), "--markdown", own("commands.md"), "--force"});
  fs::remove(own("pages/gaussmap-view.1"));
  succeed({"reference", "--man", own("pages")});
  succeed({"reference", "--man", own("pages"), "--force"});
  EXPECT_EQ(ownFiles().size(), commands_.size() + 2);  // gaussmap.1 and the directory
}

}  // namespace
}  // namespace gaussmap::test
