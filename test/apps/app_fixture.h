// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apps/run_app.h"
#include "io/files/temporary_directory.h"

namespace gaussmap::test {

using Json = nlohmann::json;

/// Tests the program as its users see it: files, exit codes, stdout and stderr.
class AppTest : public testing::Test {
 protected:
  std::string own(const std::string& name) const { return (directory_.path() / name).string(); }

  std::vector<std::string> ownFiles() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_.path()))
      names.push_back(std::filesystem::relative(entry.path(), directory_.path()).string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Returns stderr without the notes about the input.
  static std::string withoutNotes(const std::string& err) {
    std::istringstream lines(err);
    std::string rest;
    for (std::string line; std::getline(lines, line);)
      if (line.rfind("gaussmap: note: ", 0) != 0) rest += line + '\n';
    return rest;
  }

  /// Expects success and nothing but notes on stderr; returns stdout.
  static std::string succeed(const std::vector<std::string>& arguments) {
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(arguments) << outcome.err;
    EXPECT_EQ(withoutNotes(outcome.err), "");
    return outcome.out;
  }
  static Json infoOf(const std::string& map) { return Json::parse(succeed({"info", map, "--json"})); }

  /// Expects this exit code and one line on stderr that contains `word`. The program must print nothing else and create
  /// no file.
  void expectFailure(int code, const std::string& word, const std::vector<std::string>& arguments,
                     const std::function<void()>& in_child = {}) const {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const std::vector<std::string> before = ownFiles();
    Outcome outcome = runApp(arguments, "", in_child);
    outcome.err = withoutNotes(outcome.err);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find("gaussmap: "), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_LT(outcome.err.size(), 600u) << outcome.err;
    EXPECT_EQ(ownFiles(), before);
  }
  void expectUsageError(const std::string& word, const std::vector<std::string>& arguments) const {
    expectFailure(2, word, arguments);
  }
  void expectDataError(const std::string& word, const std::vector<std::string>& arguments,
                       const std::function<void()>& in_child = {}) const {
    expectFailure(1, word, arguments, in_child);
  }

  TemporaryDirectory directory_;
};

/// Five small scans of the corner and an unrefined map of them, created once for all tests.
class Apps : public AppTest {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene("").string(), "--rings", "8", "--columns", "60"}).code, 0);
    ASSERT_EQ(runApp({"pcd2map", scene("scans"), "-o", scene("map.gmap"), "--budget", "1"}).code, 0);
    ASSERT_EQ(runApp({"export", scene("map.gmap"), scene("map.pcd")}).code, 0);
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::filesystem::path scene(const std::string& name) { return scene_->path() / name; }

 private:
  static inline std::unique_ptr<TemporaryDirectory> scene_;
};

}  // namespace gaussmap::test
